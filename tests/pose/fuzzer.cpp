// A libFuzzer program of BECKON_HARNESS, a function of fuzz.h.
#include <cstdio>
#include <cstdlib>

#include "tests/pose/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string wrong = beckon::pose::BECKON_HARNESS({data, size});
  if (wrong.empty()) return 0;
  std::fprintf(stderr, "%s\n", wrong.c_str());
  std::abort();
}
