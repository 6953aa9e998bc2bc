// From an image to the objects on the table: segmentation, measurement, identity, category.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "services/perception/categoriser.h"
#include "services/perception/object_extraction.h"
#include "services/perception/object_memory.h"
#include "services/perception/object_outline.h"
#include "services/perception/segmentation.h"

namespace beckon::perception {

struct PerceiverConfig {
  SegmentationConfig segmentation;
  TrackerConfig tracker;
  double recategorise_step_m = 0.01;  // an object that moved more is looked at anew,
  double recategorise_growth = 0.2;  // so is one whose points grew or shrank by more than this part
  bool remember = true;              // false: every image stands alone, objects are numbered from 1
  int threads = 1;                   // objects are categorised by so many at a time
};

struct PerceivedObject {
  int id = 0;  // >= 1
  ExtractedObject shape;
  bool categorised = false;  // false: there is no categoriser, or too little was seen
  Categorisation category;
};

struct Perception {
  Segmentation segmentation;
  Pose X_WC = Pose::Identity();          // the camera in the table's frame W
  std::vector<PerceivedObject> objects;  // objects[k - 1] is label k of the segmentation
  double segmentation_ms = 0;            // with measuring and tracking the objects
  double categorisation_ms = 0;
  std::vector<std::pair<std::string, double>> steps_ms;  // of segmentation
};

/// Says of which category an object is; called by several threads at a time where so configured.
using Categorise = std::function<Categorisation(const ObjectView&)>;

/// Holds what is known of the objects from frame to frame.
class Perceiver {
 public:
  /// `categorise` may be empty: objects stay uncategorised.
  Perceiver(const PerceiverConfig& config, Categorise categorise)
      : config_(config),
        categorise_(std::move(categorise)),
        memory_(config.tracker, config.segmentation.sensor) {}
  /// `categoriser` may be null; it must outlive this.
  Perceiver(const PerceiverConfig& config, const Categoriser* categoriser);

  Perception Perceive(const RgbdImage& image);

 private:
  /// A category, and the view it was told from.
  struct Remembered {
    Eigen::Vector3d centroid_C;
    size_t n_points = 0;
    Categorisation category;
  };

  SteadyObjects Remember(const RgbdImage& image, Segmentation& segmentation);
  void CategoriseAll(const RgbdImage& image, Perception& perception);
  bool SameView(const ExtractedObject& shape, const Remembered& remembered) const;

  PerceiverConfig config_;
  Categorise categorise_;
  ObjectMemory memory_;
  OutlineMemory outlines_;
  std::map<int, Remembered> remembered_;
};

}  // namespace beckon::perception
