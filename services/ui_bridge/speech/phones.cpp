#include "services/ui_bridge/speech/phones.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

namespace beckon::ui_bridge::speech {
namespace {

constexpr size_t kMaxPhones = 64;

/// espeak-ng's mnemonics of its English voices; several phones with a blank between.
const std::map<std::string, std::string, std::less<>>& EspeakSounds() {
  static const std::map<std::string, std::string, std::less<>> sounds = {
      {"a", "AE"},      {"aa", "AE"},   {"A:", "AA"},     {"A", "AA"},    {"0", "AA"},
      {"0#", "AA"},     {"A~", "AA N"}, {"A@", "AA R"},   {"V", "AH"},    {"@", "AH"},
      {"@2", "AH"},     {"@5", "AH"},   {"a#", "AH"},     {"I#", "IH"},   {"I2", "IH"},
      {"I", "IH"},      {"i", "IY"},    {"i:", "IY"},     {"E", "EH"},    {"E#", "EH"},
      {"e", "EH"},      {"O:", "AO"},   {"O", "AO"},      {"O@", "AO R"}, {"o@", "AO R"},
      {"U", "UH"},      {"u:", "UW"},   {"u", "UW"},      {"3:", "ER"},   {"3", "ER"},
      {"3r", "ER"},     {"@r", "ER"},   {"@L", "AH L"},   {"aI", "AY"},   {"aI@", "AY AH"},
      {"aI3", "AY ER"}, {"aU", "AW"},   {"aU@", "AW ER"}, {"eI", "EY"},   {"OI", "OY"},
      {"oU", "OW"},     {"oU#", "OW"},  {"e@", "EH R"},   {"i@", "IY R"}, {"i@3", "IY R"},
      {"U@", "UH R"},   {"u@", "UH R"}, {"p", "P"},       {"b", "B"},     {"t", "T"},
      {"t#", "T"},      {"t2", "T"},    {"?", "T"},       {"d", "D"},     {"d#", "D"},
      {"k", "K"},       {"g", "G"},     {"f", "F"},       {"v", "V"},     {"T", "TH"},
      {"D", "DH"},      {"s", "S"},     {"z", "Z"},       {"z#", "Z"},    {"S", "SH"},
      {"Z", "ZH"},      {"tS", "CH"},   {"dZ", "JH"},     {"h", "HH"},    {"m", "M"},
      {"n", "N"},       {"n-", "AH N"}, {"m-", "AH M"},   {"N", "NG"},    {"l", "L"},
      {"l#", "L"},      {"r", "R"},     {"r-", "R"},      {"w", "W"},     {"w#", "W"},
      {"j", "Y"},       {"x", "K"}};
  return sounds;
}

/// 0 for vowels, else how a consonant is made.
int Manner(Phone phone) {
  static const std::array<int, kPhones> manners = [] {
    static constexpr std::array<std::string_view, 7> names = {
        "", " P T K B D G CH JH ", " F TH S SH HH ", " V DH Z ZH ", " M N NG ", " L R ", " W Y "};
    std::array<int, kPhones> table{};
    for (Phone i = 0; i < kPhones; ++i) {
      const std::string key = std::string(" ") + kPhoneNames[i] + " ";
      for (size_t m = 1; m < names.size(); ++m) {
        if (names[m].find(key) != std::string_view::npos) table[i] = static_cast<int>(m);
      }
    }
    return table;
  }();
  return manners[phone];
}

}  // namespace

std::optional<Phone> PhoneFromName(std::string_view name) {
  if (name.size() > 2 && name.back() >= '0' && name.back() <= '2') name.remove_suffix(1);
  for (Phone phone = 0; phone < kPhones; ++phone) {
    if (name == kPhoneNames[phone]) return phone;
  }
  return std::nullopt;
}

bool IsVowel(Phone phone) { return phone < kPhones && Manner(phone) == 0; }

Result<Pronunciation> ParsePronunciation(const std::string& text) {
  std::istringstream words(text);
  Pronunciation pronunciation;
  for (std::string name; words >> name;) {
    const auto phone = PhoneFromName(name);
    if (!phone) {
      return Error{
          "pronunciation '" + text + "': '" + name +
          "' is no phone; expected AA AE AH ... ZH with blanks between, e.g. \"S T AA P\""};
    }
    pronunciation.push_back(*phone);
  }
  if (pronunciation.empty() || pronunciation.size() > kMaxPhones) {
    return Error{"pronunciation '" + text + "': expected 1 to 64 phones, found " +
                 std::to_string(pronunciation.size())};
  }
  return pronunciation;
}

Result<Pronunciation> FromEspeak(const std::string& mnemonics) {
  std::string phones;
  std::string sound;
  const auto use = [&]() -> Status {
    if (sound.empty()) return {};
    const auto known = EspeakSounds().find(sound);
    if (known == EspeakSounds().end())
      return Error{"espeak-ng's sound '" + sound + "' is none of English"};
    const bool again = phones.ends_with("R ") && known->second == "R";  // "i@" before "r"
    if (!again) phones += known->second + " ";
    sound.clear();
    return {};
  };
  for (const char c : mnemonics) {
    if (std::string_view("_| \n").find(c) != std::string_view::npos) {
      if (auto used = use(); !used) return used.error();
    } else if (std::string_view("',%=!;").find(c) == std::string_view::npos) {
      sound += c;
    }
  }
  if (auto used = use(); !used) return used.error();
  return ParsePronunciation(phones);
}

Pronunciation WithoutR(const Pronunciation& pronunciation) {
  static const Phone er = *PhoneFromName("ER");
  static const Phone r = *PhoneFromName("R");
  static const Phone ah = *PhoneFromName("AH");
  Pronunciation result;
  for (size_t i = 0; i < pronunciation.size(); ++i) {
    const bool before_vowel = i + 1 < pronunciation.size() && IsVowel(pronunciation[i + 1]);
    if (pronunciation[i] == r && !before_vowel && i > 0) continue;
    result.push_back(pronunciation[i] == er && !before_vowel ? ah : pronunciation[i]);
  }
  return result;
}

Pronunciation WithRoundO(const Pronunciation& pronunciation) {
  static const Phone aa = *PhoneFromName("AA");
  static const Phone ao = *PhoneFromName("AO");
  static const Phone r = *PhoneFromName("R");
  Pronunciation result = pronunciation;
  for (size_t i = 0; i < result.size(); ++i) {
    const bool before_r = i + 1 < result.size() && result[i + 1] == r;
    if (result[i] == aa && !before_r) result[i] = ao;
  }
  return result;
}

std::vector<Pronunciation> InAccents(const Pronunciation& pronunciation) {
  std::vector<Pronunciation> accents{pronunciation};
  // The long "a" of "start" without its "r" is as round as the "o" of "stop".
  for (auto& other : {WithoutR(pronunciation), WithRoundO(WithoutR(pronunciation))}) {
    if (std::ranges::find(accents, other) == accents.end()) accents.push_back(other);
  }
  return accents;
}

std::string ToText(const Pronunciation& pronunciation) {
  std::string text;
  for (const Phone phone : pronunciation) {
    text += (text.empty() ? "" : " ") + std::string(phone < kPhones ? kPhoneNames[phone] : "SIL");
  }
  return text;
}

double Distance(const Pronunciation& a, const Pronunciation& b) {
  std::array<double, kMaxPhones + 1> row;
  const size_t n = std::min(b.size(), kMaxPhones);
  for (size_t j = 0; j <= n; ++j) row[j] = static_cast<double>(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    double diagonal = row[0];
    row[0] = static_cast<double>(i);
    for (size_t j = 1; j <= n; ++j) {
      const bool alike = Manner(a[i - 1]) == Manner(b[j - 1]);
      const double replace = a[i - 1] == b[j - 1] ? 0 : alike ? kAlike : 1;
      const double best = std::min({diagonal + replace, row[j] + 1, row[j - 1] + 1});
      diagonal = row[j];
      row[j] = best;
    }
  }
  return row[n];
}

}  // namespace beckon::ui_bridge::speech
