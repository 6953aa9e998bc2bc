// What is known of one object's category: every different view of it that was categorised, examples
// that look like it, and what the user said.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "services/perception/categoriser.h"
#include "services/perception/told_examples.h"

namespace beckon::perception {

struct EvidenceConfig {
  double step_m = 0.01;      // a view from so much farther along is another one,
  double growth = 0.2;       // so is one of which this part more or less is seen
  double dependence = 0.25;  // 0..1, of two views that have nothing in common: 0 says they err each
                             // for itself, 1 that the second says nothing new
  double jump_m = 0.1;       // between two looks: it may be another object of the same colours
  int most_views = 8;
  float ask_at_or_below = 0.5f;  // confidence
};

/// Where an object was seen, and how much of it.
struct SeenAt {
  Eigen::Vector3d centroid_C = Eigen::Vector3d::Zero();
  size_t n_points = 0;
};

/// What the user said of an object.
struct Told {
  std::string label_id;
  std::string category;
};

class CategoryEvidence {
 public:
  /// Whether a view differs from every one that was taken, or the object jumped.
  bool IsNew(const SeenAt& at, const EvidenceConfig& config) const;
  /// Takes a view that is new. Where the object jumped, what is known from before counts half, and
  /// what the user said holds no longer unless it looks like it did then.
  void Add(const SeenAt& at, const InstanceLook& look, Categorisation view,
           const ToldExamples& examples, const EvidenceConfig& config);
  /// Notes a view that is not new.
  void See(const SeenAt& at) { last_ = at; }

  void Tell(Told told);
  void Retract(const std::string& label_id);
  const std::optional<Told>& told() const { return told_; }
  /// The newest view's look.
  const InstanceLook* look() const { return views_.empty() ? nullptr : &views_.back().look; }
  /// Whether about as much of the object is seen as in any view of it.
  bool IsWhole(const SeenAt& at) const;
  int n_views() const { return static_cast<int>(views_.size()); }

  /// All of it together. One view without examples and without words stays as it was categorised.
  const Categorisation& Decide(const ToldExamples& examples, const EvidenceConfig& config);

 private:
  struct View {
    SeenAt at;
    InstanceLook look;
    Categorisation category;
    double weight = 1;  // halved by a jump
  };

  bool Jumped(const SeenAt& at, const EvidenceConfig& config) const;

  std::vector<View> views_;  // oldest first
  std::optional<SeenAt> last_;
  std::optional<Told> told_;
  Categorisation decided_;
  int decided_with_ = -1;  // version of the examples; -1: to be decided anew
};

/// What several views of one object say together: the product of their probabilities, each to a
/// power that falls with how much the views depend on each other, and with how little is seen.
Categorisation Combine(const std::vector<Categorisation>& views, const std::vector<SeenAt>& at,
                       const std::vector<double>& weights, const EvidenceConfig& config);

}  // namespace beckon::perception
