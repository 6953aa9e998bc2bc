// Says of which category an object is, and how sure that is, after the dissertation's chapter 4: a
// bag of words and an RBF SVM per cue, and a second SVM over all cues' confidences.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "services/base/result.h"
#include "services/perception/object_view.h"

namespace beckon::perception {

struct Model;
class Cue;

/// What one cue said, and what it cost.
struct CueDiagnostics {
  std::string name;                  // "sift", "hog", ...
  std::vector<float> probabilities;  // in the order of Categoriser::categories(), sum 1
  double milliseconds = 0;
};

struct Categorisation {
  std::vector<std::pair<std::string, float>>
      probabilities;     // most probable first, sum 1; empty where the
                         // view has fewer than kMinPoints points
  float confidence = 0;  // 0..1, 1 - H2 / log2 k with Renyi's entropy of order 2 (eq. 4.21)
  bool ask_user = true;  // confidence is at or below the threshold
  std::vector<CueDiagnostics> cues;
  double milliseconds = 0;
};

/// Thread-safe once made: every call may run in a thread of its own.
class Categoriser {
 public:
  /// Fewer points with depth than this are no view of an object.
  static constexpr int kMinPoints = 20;

  /// Reads the model that beckon-train wrote.
  static Result<Categoriser> Load(const std::string& path);

  explicit Categoriser(Model model);
  ~Categoriser();
  Categoriser(Categoriser&&) noexcept;
  Categoriser& operator=(Categoriser&&) noexcept;

  Categorisation Categorise(const ObjectView& view) const;

  /// In alphabetical order.
  const std::vector<std::string>& categories() const;

  /// At or below this confidence the user is asked; starts as the model's.
  float threshold() const { return threshold_; }
  void set_threshold(float threshold) { threshold_ = threshold; }

 private:
  std::unique_ptr<const Model> model_;
  std::vector<std::unique_ptr<const Cue>> cues_;
  float threshold_ = 0;
};

}  // namespace beckon::perception
