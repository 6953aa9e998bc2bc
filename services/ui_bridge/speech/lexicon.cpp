#include "services/ui_bridge/speech/lexicon.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <utility>

namespace beckon::ui_bridge::speech {
namespace {

constexpr size_t kLongestNear = 7;  // phones; longer words are told apart without

std::string Spelled(const std::string& word) {
  static constexpr std::array<const char*, 13> numbers = {
      "zero",  "one",   "two",  "three", "four",   "five",  "six",
      "seven", "eight", "nine", "ten",   "eleven", "twelve"};
  if (word.size() > 2 || word.empty() ||
      !std::ranges::all_of(word, [](unsigned char c) { return std::isdigit(c) != 0; })) {
    return word;
  }
  const auto number = static_cast<size_t>(std::stoi(word));
  return number < numbers.size() ? numbers[number] : word;
}

}  // namespace

void Lexicon::Add(const std::string& word, const Pronunciation& pronunciation) {
  auto& known = words_[word];
  if (std::ranges::find(known, pronunciation) == known.end()) known.push_back(pronunciation);
  if (pronunciation.size() > kLongestNear) return;
  if (by_length_.size() <= pronunciation.size()) by_length_.resize(pronunciation.size() + 1);
  by_length_[pronunciation.size()].push_back(pronunciation);
}

const std::vector<Pronunciation>& Lexicon::Find(const std::string& word) const {
  static const std::vector<Pronunciation> none;
  const auto known = words_.find(word);
  return known == words_.end() ? none : known->second;
}

Result<std::vector<Pronunciation>> Lexicon::Say(const std::string& words, size_t max) const {
  std::vector<Pronunciation> said{{}};
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    const auto& ways = Find(word);
    if (ways.empty()) return Error{"'" + word + "' is not in the dictionary"};
    std::vector<Pronunciation> longer;
    for (const auto& begin : said) {
      for (const auto& way : ways) {
        if (longer.size() == max) break;
        longer.push_back(begin);
        longer.back().insert(longer.back().end(), way.begin(), way.end());
      }
    }
    said = std::move(longer);
  }
  if (said.front().empty()) return Error{"no word to say"};
  return said;
}

std::vector<Pronunciation> Lexicon::Near(const Pronunciation& pronunciation, size_t max) const {
  std::vector<std::pair<double, Pronunciation>> near;
  const size_t n = pronunciation.size();
  for (size_t length = n - std::min<size_t>(n, 1); length <= n + 1 && length < by_length_.size();
       ++length) {
    for (const auto& other : by_length_[length]) {
      const double distance = Distance(pronunciation, other);
      if (distance > 0 && distance <= 1) near.emplace_back(distance, other);
    }
  }
  std::ranges::sort(near);
  const auto repeated = std::ranges::unique(near);
  near.erase(repeated.begin(), repeated.end());
  std::vector<Pronunciation> result;
  for (auto& [distance, other] : near) {
    if (result.size() == max) break;
    result.push_back(std::move(other));
  }
  return result;
}

std::string Normalised(const std::string& text) {
  std::string spaced;
  for (size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool word = std::isalnum(c) != 0 || (c == '\'' && i > 0);
    const bool hump =
        std::isupper(c) != 0 && i > 0 && std::islower(static_cast<unsigned char>(text[i - 1])) != 0;
    if (!word || hump) spaced += ' ';
    if (word) spaced += static_cast<char>(std::tolower(c));
  }
  std::istringstream words(spaced);
  std::string normal;
  for (std::string word; words >> word;) normal += (normal.empty() ? "" : " ") + Spelled(word);
  return normal;
}

}  // namespace beckon::ui_bridge::speech
