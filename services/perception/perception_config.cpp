// Reads beckon-perception's configuration and what it names.
#include "services/perception/perception_config.h"

#include "services/base/app.h"

namespace beckon::perception {

Result<PerceptionConfig> ReadPerceptionConfig(ConfigTable root) {
  PerceptionConfig config;
  ReadConfig(root, config.perceiver);
  ConfigTable categoriser = root.Section("categoriser");
  categoriser.Get("enabled", config.categories);
  categoriser.Get("model", config.model);
  categoriser.Get("ask_at_or_below", config.ask_at_or_below, -1, 1);
  if (Status status = root.Finish(); !status) return status.error();
  return config;
}

Result<std::optional<Categoriser>> LoadCategoriser(const PerceptionConfig& config) {
  if (!config.categories) return std::optional<Categoriser>();
  const std::string file = config.model.empty() ? SharedFile("categories.model") : config.model;
  auto categoriser = Categoriser::Load(file);
  if (!categoriser) {
    return Error{categoriser.error().message +
                 "; name a model by --model, make one by beckon-train, or go without by "
                 "--no-categories"};
  }
  if (config.ask_at_or_below >= 0) {
    categoriser->set_threshold(static_cast<float>(config.ask_at_or_below));
  }
  return std::optional<Categoriser>(*std::move(categoriser));
}

}  // namespace beckon::perception
