// The list that front end files enter themselves into when the program starts.
#include <algorithm>

#include "services/ui_bridge/front_end.h"

namespace beckon::ui_bridge {
namespace {

/// Inside a function: it must exist before the first registration, in whatever order files start.
std::vector<FrontEndRegistration::Make>& Makers() {
  static std::vector<FrontEndRegistration::Make> makers;
  return makers;
}

}  // namespace

FrontEndRegistration::FrontEndRegistration(Make make) { Makers().push_back(make); }

std::vector<std::unique_ptr<FrontEndFactory>> MakeFrontEndFactories() {
  std::vector<std::unique_ptr<FrontEndFactory>> factories;
  for (const auto make : Makers()) factories.push_back(make());
  std::ranges::sort(factories, {}, [](const auto& factory) { return factory->name(); });
  return factories;
}

std::vector<double> OneHot(size_t option, size_t n) {
  std::vector<double> likelihoods(n, 0.0);
  likelihoods.at(option) = 1.0;
  return likelihoods;
}

}  // namespace beckon::ui_bridge
