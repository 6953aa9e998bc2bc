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

struct Decider;
struct Model;
class Cue;

/// What one cue said, and what it cost.
struct CueDiagnostics {
  std::string name;                  // "sift", "hog", ...
  std::vector<float> probabilities;  // in the order of Categoriser::categories(), sum 1; empty
                                     // where the view holds nothing that the cue looks at
  double milliseconds = 0;
};

struct Categorisation {
  std::vector<std::pair<std::string, float>>
      probabilities;     // most probable first, sum 1; may begin with
                         // kUnknown; empty where `reason` says why
  std::string reason;    // why there is no answer at all; else empty
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
  /// What is larger along the table or above it is no object to take, whatever it looks like.
  static constexpr float kMaxExtent_m = 1;

  /// Reads the model that beckon-train wrote.
  static Result<Categoriser> Load(const std::string& path);

  explicit Categoriser(Model model);
  ~Categoriser();
  Categoriser(Categoriser&&) noexcept;
  Categoriser& operator=(Categoriser&&) noexcept;

  /// Only these of the model's cues have a say from now on: "all", "dissertation" (its chapter 4:
  /// its three cues and a second machine over them, nothing else) or names parted by commas. A
  /// single cue and the dissertation's have a decider of their own; for other sets the decider of
  /// all takes the missing ones as not seen. The threshold becomes that of the decider.
  Status UseCues(const std::string& names);

  Categorisation Categorise(const ObjectView& view) const;

  /// In alphabetical order.
  const std::vector<std::string>& categories() const;

  /// At or below this confidence the user is asked; starts as the model's.
  float threshold() const { return threshold_; }
  void set_threshold(float threshold) { threshold_ = threshold; }

  /// Factor on the probability of kUnknown; starts as the model's.
  float unknown_prior() const { return unknown_prior_; }
  void set_unknown_prior(float prior) { unknown_prior_ = prior; }

 private:
  std::unique_ptr<const Model> model_;
  std::vector<std::unique_ptr<const Cue>> cues_;
  std::vector<uint32_t> used_;        // the cues that have a say, increasing
  const Decider* decider_ = nullptr;  // of *model_
  float threshold_ = 0;
  float unknown_prior_ = 1;
};

}  // namespace beckon::perception
