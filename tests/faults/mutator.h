// Datagrams of LCM's UDP protocol, damaged in every way that came to mind. Pure and seeded.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace beckon::faults {

using Datagram = std::vector<uint8_t>;

/// Whether LCM takes it for a part of a large message.
bool IsFragment(const Datagram& datagram);

class Mutator {
 public:
  explicit Mutator(uint64_t seed) : random_(seed) {}

  /// Of real datagrams (at least one): bits flipped, cut, spliced, on another channel, with huge
  /// lengths, noise. Never a fragment.
  Datagram Mutate(const std::vector<Datagram>& real);
  /// A fragment whose header lies: wrapping offset, size, number, count.
  Datagram HostileFragment();
  /// Noise, with or without a header of LCM's before it.
  Datagram Junk(size_t longest = 400);

 private:
  uint64_t Below(uint64_t n) { return random_() % n; }
  Datagram Noise(size_t size);
  Datagram Change(const std::vector<Datagram>& real);
  void FlipBits(Datagram& datagram);
  void WriteHugeLength(Datagram& datagram);
  Datagram OtherChannel(const std::vector<Datagram>& real);
  uint32_t Extreme();

  std::mt19937_64 random_;
};

}  // namespace beckon::faults
