#include "tests/faults/mutator.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace beckon::faults {
namespace {

// LCM's UDP protocol: "LC02", number, channel, 0, message; or "LC03", number, size of the whole
// message, offset of this part, number of this part, number of parts, (in part 0: channel, 0),
// part.
constexpr size_t kHeader = 8;
constexpr std::array<uint8_t, 4> kShort = {'L', 'C', '0', '2'}, kPart = {'L', 'C', '0', '3'};
constexpr size_t kLongestChannel = 63;
constexpr std::array<const char*, 6> kChannels = {"BECKON_FRAME",  "BECKON_SCENE",
                                                  "BECKON_QUERY",  "BECKON_TASK",
                                                  "BECKON_ANSWER", "BECKON_SESSION"};

void Append(Datagram& datagram, uint32_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    datagram.push_back(static_cast<uint8_t>(value >> shift));
}

void Append(Datagram& datagram, const std::string& text) {
  datagram.insert(datagram.end(), text.begin(), text.end());
}

bool StartsWith(const Datagram& datagram, const std::array<uint8_t, 4>& magic) {
  return datagram.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), datagram.begin());
}

/// Where the message begins.
size_t BodyOf(const Datagram& datagram) {
  const auto from =
      datagram.begin() + static_cast<std::ptrdiff_t>(std::min(kHeader, datagram.size()));
  const auto zero = std::find(from, datagram.end(), 0);
  return static_cast<size_t>(zero - datagram.begin()) + (zero == datagram.end() ? 0 : 1);
}

}  // namespace

bool IsFragment(const Datagram& datagram) { return StartsWith(datagram, kPart); }

Datagram Mutator::Noise(size_t size) {
  Datagram noise(size);
  std::ranges::generate(noise, [this] { return static_cast<uint8_t>(random_()); });
  return noise;
}

uint32_t Mutator::Extreme() {
  constexpr std::array<uint32_t, 8> kValues = {0,          1,          0x7fffffff, 0x80000000,
                                               0xffffffff, 0xfffffff0, 0x10000000, 65'500};
  return Below(3) == 0 ? static_cast<uint32_t>(random_()) : kValues[Below(kValues.size())];
}

void Mutator::FlipBits(Datagram& datagram) {
  for (uint64_t flips = 1 + Below(16); flips > 0 && !datagram.empty(); --flips)
    datagram[Below(datagram.size())] ^= static_cast<uint8_t>(1U << Below(8));
}

void Mutator::WriteHugeLength(Datagram& datagram) {
  const size_t body = BodyOf(datagram);
  if (datagram.size() < body + 4) return;
  Datagram length;
  Append(length, Extreme(), 4);
  std::ranges::copy(length, datagram.begin() + static_cast<std::ptrdiff_t>(
                                                   body + Below(datagram.size() - body - 3)));
}

Datagram Mutator::OtherChannel(const std::vector<Datagram>& real) {
  const Datagram& one = real[Below(real.size())];
  Datagram made(one.begin(),
                one.begin() + static_cast<std::ptrdiff_t>(std::min(kHeader, one.size())));
  switch (Below(3)) {
    case 0:
      Append(made, kChannels[Below(kChannels.size())]);
      made.push_back(0);
      break;
    case 1:  // longer than LCM allows
      Append(made, std::string(kLongestChannel + Below(200), 'B'));
      made.push_back(0);
      break;
    default:  // without an end
      Append(made, "BECKON_TASK");
      return made;
  }
  const auto body = static_cast<std::ptrdiff_t>(BodyOf(one));
  made.insert(made.end(), one.begin() + body, one.end());
  return made;
}

Datagram Mutator::Change(const std::vector<Datagram>& real) {
  Datagram made = real[Below(real.size())];
  switch (Below(9)) {
    case 0:
      FlipBits(made);
      break;
    case 1:
      made.resize(Below(made.size() + 1));
      break;
    case 2: {  // the beginning of one, the end of another
      const Datagram& other = real[Below(real.size())];
      made.resize(Below(made.size() + 1));
      made.insert(made.end(), other.begin() + static_cast<std::ptrdiff_t>(Below(other.size() + 1)),
                  other.end());
      break;
    }
    case 3:
      return OtherChannel(real);
    case 4:
      for (uint64_t lengths = 1 + Below(3); lengths > 0; --lengths) WriteHugeLength(made);
      break;
    case 5: {  // trailing bytes
      const auto more = Noise(Below(2000));
      made.insert(made.end(), more.begin(), more.end());
      break;
    }
    case 6:
      return Junk(Below(10) == 0 ? 60'000 : 400);
    case 7: {  // bytes missing from the middle
      const size_t from = Below(made.size() + 1), n = Below(made.size() - from + 1);
      made.erase(made.begin() + static_cast<std::ptrdiff_t>(from),
                 made.begin() + static_cast<std::ptrdiff_t>(from + n));
      break;
    }
    default:  // only the message, not what LCM needs, is hurt
      for (uint64_t n = 1 + Below(8); n > 0 && BodyOf(made) < made.size(); --n) {
        const size_t body = BodyOf(made);
        made[body + Below(made.size() - body)] = static_cast<uint8_t>(random_());
      }
  }
  return made;
}

Datagram Mutator::Mutate(const std::vector<Datagram>& real) {
  while (true) {
    Datagram made = Change(real);
    if (made.size() > 65'000) made.resize(65'000);
    if (!IsFragment(made)) return made;
  }
}

Datagram Mutator::HostileFragment() {
  Datagram made(kPart.begin(), kPart.end());
  Append(made, static_cast<uint32_t>(Below(4)), 4);  // few numbers, so that parts meet
  Append(made, Extreme(), 4);
  Append(made, Extreme(), 4);
  Append(made, static_cast<uint32_t>(Below(4)), 2);
  Append(made, static_cast<uint32_t>(Below(2) == 0 ? Below(4) : Below(65'536)), 2);
  if (Below(2) == 0) {
    Append(made, kChannels[Below(kChannels.size())]);
    made.push_back(0);
  }
  const auto part = Noise(Below(2000));
  made.insert(made.end(), part.begin(), part.end());
  return made;
}

Datagram Mutator::Junk(size_t longest) {
  Datagram made = Noise(Below(longest + 1));
  if (Below(2) == 0 || made.size() < kHeader) return made;
  std::ranges::copy(kShort, made.begin());
  if (Below(2) == 0) {
    const std::string channel = kChannels[Below(kChannels.size())];
    if (made.size() < kHeader + channel.size() + 1) return made;
    std::ranges::copy(channel, made.begin() + kHeader);
    made[kHeader + channel.size()] = 0;
  }
  return made;
}

}  // namespace beckon::faults
