// liblsl, found when the program runs: Debian has no package of it, and most people need none.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "services/base/result.h"

namespace beckon::ui_bridge::bci {

/// The few functions of Lab Streaming Layer's C interface that reading a stream takes (labstreaming
/// layer.readthedocs.io, lsl_c.h of liblsl 1.13 and later).
struct LslLibrary {
  using Info = void*;
  using Inlet = void*;
  int32_t (*resolve_byprop)(Info* found, uint32_t most, const char* property, const char* value,
                            int32_t at_least, double timeout_s);
  int32_t (*get_channel_count)(Info info);
  void (*destroy_streaminfo)(Info info);
  Inlet (*create_inlet)(Info info, int32_t buffer_s, int32_t chunk, int32_t recover);
  uint32_t (*set_postprocessing)(Inlet inlet, uint32_t flags);
  double (*pull_sample_d)(Inlet inlet, double* values, int32_t n, double timeout_s, int32_t* error);
  void (*destroy_inlet)(Inlet inlet);
  double (*local_clock)();

  static constexpr uint32_t kSynchroniseClocks = 1;  // proc_clocksync
  static constexpr int32_t kLost = -2;               // lsl_lost_error
};

/// `path`: empty tries liblsl.so.2 and liblsl.so where the loader looks. Stays loaded for good.
Result<LslLibrary> LoadLsl(const std::string& path);

}  // namespace beckon::ui_bridge::bci
