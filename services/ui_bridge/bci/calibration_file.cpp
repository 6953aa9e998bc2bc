#include "services/ui_bridge/bci/calibration_file.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

namespace beckon::ui_bridge::bci {
namespace {

namespace fs = std::filesystem;
constexpr int kVersion = 1;
constexpr uintmax_t kLargest = 4'000'000;  // bytes

bool IsPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_' || c == '.';
}

/// FNV-1a.
uint32_t Checksum(const std::string& text) {
  uint32_t hash = 2'166'136'261u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16'777'619u;
  return hash;
}

Result<Calibration> Parse(const std::string& path, size_t classes,
                          const CalibrationConfig& config) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  const auto json = nlohmann::json::parse(text.str(), nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return Error{"not a calibration (it may be torn)"};
  try {
    if (json.at("version").get<int>() != kVersion) return Error{"of another version"};
    if (json.at("classes").get<size_t>() != classes) {
      return Error{"expected " + std::to_string(classes) + " classes, found " +
                   json.at("classes").dump()};
    }
    Calibration calibration(classes, config);
    for (const auto& trial : json.at("trials")) {
      if (!calibration.Add({trial.at(0).get<size_t>(), trial.at(1).get<std::vector<double>>()}))
        return Error{"a trial is not one of such a decoder"};
    }
    return calibration;
  } catch (const nlohmann::json::exception& wrong) {
    return Error{wrong.what()};
  }
}

}  // namespace

std::string CalibrationFileName(const std::string& user, const std::string& decoder,
                                size_t classes) {
  const std::string name = user + "." + decoder;
  std::string plain;
  for (const char c : name) plain += IsPlain(c) ? c : '_';
  plain = plain.substr(0, 150);
  if (plain != name || user.find('.') != std::string::npos) {
    char sum[16];
    std::snprintf(sum, sizeof sum, "-%08x", Checksum(user + '\n' + decoder));
    plain += sum;
  }
  return plain + "." + std::to_string(classes) + ".json";
}

LoadedCalibration LoadCalibration(const std::string& path, size_t classes,
                                  const CalibrationConfig& config) {
  std::error_code failed;
  if (!fs::exists(path, failed)) return {Calibration(classes, config), ""};
  const uintmax_t size = fs::file_size(path, failed);
  auto read = failed || size > kLargest ? Result<Calibration>(Error{"not a file of usual size"})
                                        : Parse(path, classes, config);
  if (read) return {*std::move(read), ""};
  fs::rename(path, path + ".bad", failed);
  return {Calibration(classes, config),
          path + ": " + read.error().message + "; calibration starts anew" +
              (failed ? "" : ", the file is kept as " + path + ".bad")};
}

Status SaveCalibration(const std::string& path, const Calibration& calibration) {
  nlohmann::json trials = nlohmann::json::array();
  for (const KnownTrial& trial : calibration.trials()) {
    std::vector<double> rounded = trial.probabilities;
    for (double& p : rounded) p = std::round(p * 1e5) / 1e5;
    trials.push_back({trial.meant, rounded});
  }
  const nlohmann::json json = {
      {"version", kVersion}, {"classes", calibration.classes()}, {"trials", trials}};
  std::error_code failed;
  fs::create_directories(fs::path(path).parent_path(), failed);
  const std::string fresh = path + ".new";
  std::ofstream file(fresh, std::ios::binary | std::ios::trunc);
  file << json.dump() << '\n';
  file.close();
  if (!file) return Error{fresh + ": could not be written"};
  fs::rename(fresh, path, failed);
  if (failed) return Error{path + ": could not be replaced: " + failed.message()};
  return {};
}

}  // namespace beckon::ui_bridge::bci
