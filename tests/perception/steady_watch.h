// Measures how steadily a perceiver shows a table that stands still, and how soon it notices what
// does not.
#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <vector>

#include "services/perception/perceiver.h"
#include "tests/perception/steady_table.h"

namespace beckon::perception {

/// How a table was shown from some frame on.
struct Steadiness {
  int id_changes = 0;           // frames that show other ids than the one before
  double least_outline = 1;     // least IoU of an object's outlines in consecutive frames,
  double low_outline = 1;       // what 95 % of them exceed,
  double least_silhouette = 1;  // the same of silhouettes
  double least_labels = 1;      // and of the pixels that have depth
  double most_centroid_m = 0;  // rms about its mean, in W, of the object whose centroid strays most
  double table_m = 0;          // the same of the table's distance from the camera
  double table_rad = 0;        // and of its normal
};

/// Watches frame by frame.
class SteadyWatch {
 public:
  void Add(const RgbdImage& image, const Perception& perception);

  /// Of the frames from `first` on (the first is 0) against the frame before each.
  Steadiness From(int first) const;
  /// The frame from which on ids never change.
  int FinalFrom() const;
  /// Of all frames: ids that were shown in any.
  std::set<int> Ids() const;

 private:
  struct Sight {
    cv::Mat outline, silhouette, labels;
  };
  struct Shown {
    Eigen::Vector3d centroid_W;
    bool before = false;  // it was shown in the frame before, and overlaps that by
    double outline = 1, silhouette = 1, labels = 1;
  };
  struct Frame {
    std::map<int, Shown> objects;
    Plane table_C;
  };
  bool ChangesAt(size_t frame) const;

  std::map<int, Sight> last_;
  std::vector<Frame> frames_;
};

std::set<int> Ids(const Perception& perception);

/// The id of the object that has most of the pixels of a true label; 0 = less than a third of them
/// are any object's.
int IdOf(const Perception& perception, const std::vector<uint16_t>& truth, int object);

/// How well an object of the table is shown: the IoU of its true pixels and those of the object
/// that has most of them.
double Accuracy(const Perception& perception, const std::vector<uint16_t>& truth, int object);

/// Frames until something was noticed, `kNever` where it was not, and whether the id stayed right
/// from then on.
struct Notice {
  static constexpr int kNever = 99;
  int after_frames = kNever;
  bool right_id = false;
};

/// What happens to one object of a table that is known.
Notice WatchMove(SteadyTable& table, Perceiver& perceiver, int object, double dx_m, double dy_m);
Notice WatchRemoval(SteadyTable& table, Perceiver& perceiver, int object);
/// `id`: that it had.
Notice WatchReturn(SteadyTable& table, Perceiver& perceiver, int object, int id);

}  // namespace beckon::perception
