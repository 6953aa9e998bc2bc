#include "services/intention/core/history_row.h"

namespace beckon::intention {
namespace {

/// MurmurHash3's 64-bit finaliser: every bit of the input reaches every bit of the output.
uint64_t Mix(uint64_t h) {
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdULL;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33);
}

/// FNV-1a, with a terminating zero so that ("ab", "c") and ("a", "bc") differ.
uint64_t Add(uint64_t h, const std::string& text) {
  for (const char c : text) h = (h ^ static_cast<uint8_t>(c)) * 0x100000001b3ULL;
  return h * 0x100000001b3ULL;
}

}  // namespace

uint64_t RowHash(const HistoryRow& row) {
  uint64_t h = Add(0xcbf29ce484222325ULL, row.origin);
  h = Add(h, row.kind);
  h = Add(h, row.body);
  h = Mix(h ^ static_cast<uint64_t>(row.seq));
  return Mix(h ^ static_cast<uint64_t>(row.hybrid_utime));
}

uint64_t ExtendChain(uint64_t chain, uint64_t row_hash) {
  return Mix(chain * 0x9e3779b97f4a7c15ULL + row_hash);
}

}  // namespace beckon::intention
