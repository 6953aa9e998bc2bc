// What a cue is: one way of looking at an object that yields numbers for a classifier.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/perception/cue_view.h"

namespace beckon::perception {

using Descriptors = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// How a cue's numbers become a feature vector in 0..1.
enum class Encoding {
  kBag,         // any number of local descriptors (rows): a bag of words
  kStatistics,  // one row of measurements in any units: each replaced by its quantile in training
  kDense,       // one row of numbers that lie in 0..1 already
};

/// A cue is stateless: what is learnt lives in the model under the cue's name.
class Cue {
 public:
  virtual ~Cue() = default;
  virtual std::string name() const = 0;
  virtual Encoding encoding() const = 0;
  virtual int dimension() const = 0;  // columns of what Describe returns
  /// Whether the view holds what this cue looks at; where not, it has no say about the object.
  virtual bool CanSee(const CueView&) const { return true; }
  /// How much it counts where cues are blended: what a rendering shows of the world, 0 .. 1.
  virtual float weight() const { return 1; }
  /// All finite. Rows: any number (kBag), else exactly one. Only where CanSee.
  virtual Descriptors Describe(const CueView& view) const = 0;
};

/// All cues, in the order in which models keep them. A new cue is one file and one line in
/// cue_list.cpp.
std::vector<std::unique_ptr<const Cue>> MakeCues();

/// The cue of that name, null where there is none.
std::unique_ptr<const Cue> MakeCue(const std::string& name);

/// The dissertation's three: SIFT, HOG and FPFH bags of words.
const std::vector<std::string>& DissertationCues();

/// "all", "dissertation" or names parted by commas: those names of `known` it stands for, in
/// `known`'s order. Fails on a name that is not there and on nothing.
Result<std::vector<std::string>> ParseCueNames(const std::string& text,
                                               const std::vector<std::string>& known);

}  // namespace beckon::perception
