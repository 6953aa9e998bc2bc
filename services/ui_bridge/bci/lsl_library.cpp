#include "services/ui_bridge/bci/lsl_library.h"

#include <dlfcn.h>

#include <vector>

namespace beckon::ui_bridge::bci {
namespace {

template <typename Function>
bool Find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

std::string LastError() {
  const char* error = dlerror();
  return error != nullptr ? error : "not found";
}

}  // namespace

Result<LslLibrary> LoadLsl(const std::string& path) {
  const std::vector<std::string> names =
      path.empty() ? std::vector<std::string>{"liblsl.so.2", "liblsl.so"} : std::vector{path};
  void* library = nullptr;
  std::string why;
  for (const auto& name : names) {
    if ((library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) != nullptr) break;
    why += (why.empty() ? "" : "; ") + LastError();
  }
  if (library == nullptr) {
    return Error{"[bci] lsl: liblsl cannot be loaded (" + why +
                 "): install liblsl, name it in [bci] lsl_library, or have the decoder answer by "
                 "the LCM message DECODING"};
  }
  LslLibrary lsl{};
  const bool whole = Find(library, "lsl_resolve_byprop", lsl.resolve_byprop) &&
                     Find(library, "lsl_get_channel_count", lsl.get_channel_count) &&
                     Find(library, "lsl_destroy_streaminfo", lsl.destroy_streaminfo) &&
                     Find(library, "lsl_create_inlet", lsl.create_inlet) &&
                     Find(library, "lsl_set_postprocessing", lsl.set_postprocessing) &&
                     Find(library, "lsl_pull_sample_d", lsl.pull_sample_d) &&
                     Find(library, "lsl_destroy_inlet", lsl.destroy_inlet) &&
                     Find(library, "lsl_local_clock", lsl.local_clock);
  if (!whole) {
    const std::string missing = LastError();
    dlclose(library);
    return Error{"[bci] lsl: " + (path.empty() ? std::string("liblsl") : path) +
                 " is not liblsl 1.13 or later: " + missing};
  }
  return lsl;
}

}  // namespace beckon::ui_bridge::bci
