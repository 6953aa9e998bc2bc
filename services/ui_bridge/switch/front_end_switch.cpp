// Front end "switch": scanning for a person with one working muscle, on an evdev device or a key of
// the terminal, seen and heard.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>

#include "services/ui_bridge/switch/switch_front_end.h"

namespace beckon::ui_bridge {
namespace {

constexpr Utime kKeyRepeat_us = 700'000;  // a terminal's keys begin to repeat within this

class SwitchFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "switch"; }
  std::string summary() const override {
    return "scanning with one or two switches, or keys of the terminal";
  }

  void AddOptions(CLI::App& app) override {
    auto* group = app.add_option_group("switch", "Options of the switch front end");
    group
        ->add_option("--switch-device", device_,
                     "An input device, name:TEXT, uniq:TEXT, a FIFO, or \"terminal\"")
        ->type_name("DEVICE");
  }

  void Configure(ConfigTable table) override { ReadSwitchConfig(std::move(table), config_); }

  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    SwitchConfig config = config_;
    if (!device_.empty()) config.device = device_;
    if (const Status right = ValidateSwitch(config); !right) return right.error();
    if (!TellsRelease(config)) {
      config.scan.ignore_repeat_us = std::max(config.scan.ignore_repeat_us, kKeyRepeat_us);
    }
    return std::unique_ptr<FrontEnd>(std::make_unique<SwitchFrontEnd>(config, setup));
  }

 private:
  std::string device_;
  SwitchConfig config_;
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<SwitchFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge
