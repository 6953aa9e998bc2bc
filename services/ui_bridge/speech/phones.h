// The sounds of English as the recogniser knows them (ARPAbet, 39 phones), and pronunciations made
// of them: written out, or taken from espeak-ng's mnemonics.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/base/result.h"

namespace beckon::ui_bridge::speech {

/// An index into kPhoneNames.
using Phone = uint16_t;
using Pronunciation = std::vector<Phone>;

inline constexpr const char* kPhoneNames[] = {
    "AA", "AE", "AH", "AO", "AW", "AY", "B",  "CH", "D", "DH", "EH", "ER", "EY",
    "F",  "G",  "HH", "IH", "IY", "JH", "K",  "L",  "M", "N",  "NG", "OW", "OY",
    "P",  "R",  "S",  "SH", "T",  "TH", "UH", "UW", "V", "W",  "Y",  "Z",  "ZH"};
inline constexpr Phone kPhones = 39;
/// No phone: silence.
inline constexpr Phone kSilence = kPhones;

/// "AH", also with a stress digit ("AH0"); upper case.
std::optional<Phone> PhoneFromName(std::string_view name);
bool IsVowel(Phone phone);

/// "S T AA P": 1 .. 64 phones with blanks between them.
Result<Pronunciation> ParsePronunciation(const std::string& text);
/// What `espeak-ng -q -x --sep=_` prints for a word: "s_t_'0_p". An error names a sound that is
/// not English.
Result<Pronunciation> FromEspeak(const std::string& mnemonics);
/// As it is said where "r" is silent after vowels: "N AH M B ER" becomes "N AH M B AH".
Pronunciation WithoutR(const Pronunciation& pronunciation);
/// As it is said where the "o" of "stop" is round: "S T AA P" becomes "S T AO P".
Pronunciation WithRoundO(const Pronunciation& pronunciation);
/// All of them, and what was given: how it is said in one accent or another.
std::vector<Pronunciation> InAccents(const Pronunciation& pronunciation);
/// "S T AA P"
std::string ToText(const Pronunciation& pronunciation);

/// How many phones have to be replaced, left out or put in to make `b` of `a`, where replacing a
/// vowel by a vowel or a consonant by one made alike (P, T, K ...) counts `kAlike`.
double Distance(const Pronunciation& a, const Pronunciation& b);
inline constexpr double kAlike = 0.6;

}  // namespace beckon::ui_bridge::speech
