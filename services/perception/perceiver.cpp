// The steps of perceiving one image.
#include "services/perception/perceiver.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

#include "services/base/utime.h"

namespace beckon::perception {

Perceiver::Perceiver(const PerceiverConfig& config, const Categoriser* categoriser)
    : Perceiver(
          config, categoriser == nullptr ? Categorise() : [categoriser](const ObjectView& view) {
            return categoriser->Categorise(view);
          }) {}

Perception Perceiver::Perceive(const RgbdImage& image) {
  Perception perception;
  const Stopwatch whole;
  double told_ms = 0;
  perception.segmentation = Segment(image, config_.segmentation, [&](const StepDone& step) {
    const double now_ms = whole.Milliseconds();
    perception.steps_ms.emplace_back(step.name, now_ms - told_ms);
    told_ms = now_ms;
  });
  if (perception.segmentation.table_C) {
    perception.X_WC = WorldFromTable(*perception.segmentation.table_C);
  }
  const SteadyObjects steady = Remember(image, perception.segmentation);
  auto shapes = ExtractObjects(image, perception.segmentation, perception.X_WC, steady.silhouettes);
  outlines_.Draw(image.width, steady.ids, shapes);
  for (size_t i = 0; i < shapes.size(); ++i) {
    PerceivedObject object;
    object.id = steady.ids[i];
    object.shape = std::move(shapes[i]);
    perception.objects.push_back(std::move(object));
  }
  perception.segmentation_ms = whole.Milliseconds();
  perception.steps_ms.emplace_back("objects", perception.segmentation_ms - told_ms);

  const Stopwatch categorisation;
  if (categorise_) CategoriseAll(image, perception);
  perception.categorisation_ms = categorisation.Milliseconds();
  return perception;
}

SteadyObjects Perceiver::Remember(const RgbdImage& image, Segmentation& segmentation) {
  if (config_.remember) {
    return memory_.Update(image, config_.segmentation.max_objects, segmentation);
  }
  std::vector<int> ids(segmentation.n_objects);
  std::iota(ids.begin(), ids.end(), 1);
  return {ids, segmentation.labels};
}

bool Perceiver::SameView(const ExtractedObject& shape, const Remembered& remembered) const {
  const double before = static_cast<double>(remembered.n_points);
  const double now = static_cast<double>(shape.pixels.size());
  return (shape.centroid_C - remembered.centroid_C).norm() <= config_.recategorise_step_m &&
         std::abs(now - before) <= config_.recategorise_growth * before;
}

void Perceiver::CategoriseAll(const RgbdImage& image, Perception& perception) {
  std::vector<PerceivedObject*> unseen;
  for (auto& object : perception.objects) {
    const auto known = remembered_.find(object.id);
    if (known != remembered_.end() && SameView(object.shape, known->second)) {
      object.category = known->second.category;
    } else {
      unseen.push_back(&object);
    }
  }

  std::atomic<size_t> next = 0;
  std::mutex failure_mutex;
  std::exception_ptr failure;
  auto work = [&] {
    try {
      for (size_t i; (i = next++) < unseen.size();) {
        unseen[i]->category =
            categorise_({image, unseen[i]->shape.pixels, perception.segmentation.table_C});
      }
    } catch (...) {  // must not leave a thread
      std::lock_guard lock(failure_mutex);
      failure = std::current_exception();
    }
  };
  const size_t n_threads = std::min<size_t>(config_.threads, unseen.size());
  std::vector<std::jthread> others;
  for (size_t i = 1; i < n_threads; ++i) others.emplace_back(work);
  work();
  others.clear();  // joins
  if (failure) std::rethrow_exception(failure);

  for (PerceivedObject* object : unseen) {
    remembered_[object->id] = {object->shape.centroid_C, object->shape.pixels.size(),
                               object->category};
  }
  for (auto& object : perception.objects) {
    object.categorised = !object.category.probabilities.empty();
  }
  std::erase_if(remembered_, [this](const auto& entry) { return !memory_.Remembers(entry.first); });
}

}  // namespace beckon::perception
