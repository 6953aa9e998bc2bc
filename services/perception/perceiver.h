// From an image to the objects on the table: segmentation, measurement, identity, category.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/perception/categoriser.h"
#include "services/perception/category_evidence.h"
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
  EvidenceConfig evidence;           // its step and growth are those above
  int views_per_object = 4;          // kept as examples of an object that the user named
};

struct PerceivedObject {
  int id = 0;  // >= 1
  ExtractedObject shape;
  bool categorised = false;  // false: there is no categoriser, or too little was seen
  Categorisation category;   // of all that is known of it
  std::optional<Told> told;  // what the user said it is
  bool is_example = false;   // this view became one, of what was said
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
        memory_(config.tracker, config.segmentation.sensor) {
    config_.evidence.step_m = config.recategorise_step_m;
    config_.evidence.growth = config.recategorise_growth;
  }
  /// `categoriser` may be null; it must outlive this.
  Perceiver(const PerceiverConfig& config, const Categoriser* categoriser);

  Perception Perceive(const RgbdImage& image);

  /// The user said what an object is, which holds from the next image on; examples of what was said
  /// under the same label go. The label of something else that was said of it before, which no
  /// longer holds, is returned; nullopt where no object has this id.
  std::optional<std::string> Tell(int id, const Told& told);
  /// What was said under a label does not hold, nor do its examples.
  void Retract(const std::string& label_id);
  /// An object that was named before, to be recognised.
  void Learn(ToldExample example) { examples_.Add(std::move(example)); }
  const ToldExamples& examples() const { return examples_; }

 private:
  SteadyObjects Remember(const RgbdImage& image, Segmentation& segmentation);
  void CategoriseAll(const RgbdImage& image, Perception& perception);
  std::vector<Categorisation> CategoriseEach(const RgbdImage& image, const Perception& perception,
                                             const std::vector<PerceivedObject*>& objects) const;
  void MakeExample(const ObjectView& view, bool is_new, PerceivedObject& object);

  PerceiverConfig config_;
  Categorise categorise_;
  ObjectMemory memory_;
  OutlineMemory outlines_;
  std::map<int, CategoryEvidence> evidence_;  // by object
  ToldExamples examples_;
};

}  // namespace beckon::perception
