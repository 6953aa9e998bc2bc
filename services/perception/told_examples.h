// Objects that the user named before, as they looked: recognised again, they are evidence of what
// an object is.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "services/perception/instance_look.h"

namespace beckon::perception {

/// One view of an object that was named.
struct ToldExample {
  std::string label_id;  // of the object: views of one have it in common
  std::string category;  // as the user said; "Unknown": of none
  InstanceLook look;
};

/// Difference of looks beyond which an example says nothing. Fewer than 1 % of pairs of views of
/// two products are below it (docs/model.md).
inline constexpr double kRecognisedBelow = 3.0;

class ToldExamples {
 public:
  void Add(ToldExample example);
  /// All views of an object.
  void Remove(const std::string& label_id);
  int Count(const std::string& label_id) const;
  const std::vector<ToldExample>& all() const { return examples_; }
  /// Grows with every change.
  int version() const { return version_; }

  /// By category: how much likelier (logarithm, > 0) an object of one of these looks is to look so
  /// where it is of the category than where it is not, by the likest example of the category; the
  /// less the more objects there are to compare with.
  /// Categories without an example alike are left out.
  std::map<std::string, double> Evidence(const std::vector<InstanceLook>& looks) const;
  /// Whether a look is like one of an object's views.
  bool IsLike(const std::string& label_id, const InstanceLook& look) const;

 private:
  std::vector<ToldExample> examples_;
  int version_ = 0;
};

/// The logarithm of a difference's likelihood ratio: views of one thing against views of two. 0
/// beyond kRecognisedBelow.
double LogLikelihoodRatio(double difference);

}  // namespace beckon::perception
