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

namespace {

PerceiverConfig WithThreshold(PerceiverConfig config, const Categoriser* categoriser) {
  if (categoriser != nullptr) config.evidence.ask_at_or_below = categoriser->threshold();
  return config;
}

SeenAt At(const PerceivedObject& object) {
  return {object.shape.centroid_C, object.shape.pixels.size()};
}

}  // namespace

Perceiver::Perceiver(const PerceiverConfig& config, const Categoriser* categoriser)
    : Perceiver(
          WithThreshold(config, categoriser),
          categoriser == nullptr ? Categorise() : [categoriser](const ObjectView& view) {
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
  CategoriseAll(image, perception);
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

/// Only views that may change what is known of an object are categorised.
void Perceiver::CategoriseAll(const RgbdImage& image, Perception& perception) {
  const auto view = [&](const PerceivedObject& object) {
    return ObjectView{image, object.shape.pixels, perception.segmentation.table_C};
  };
  std::vector<PerceivedObject*> fresh;
  for (auto& object : perception.objects) {
    CategoryEvidence& known = evidence_[object.id];
    known.IsNew(At(object), config_.evidence) ? fresh.push_back(&object) : known.See(At(object));
  }
  std::vector<Categorisation> said(fresh.size());
  if (categorise_) said = CategoriseEach(image, perception, fresh);
  // Where nothing is remembered and nothing was, there is nothing to compare looks with.
  const bool compare = config_.remember || !examples_.all().empty();
  for (size_t i = 0; i < fresh.size(); ++i) {
    InstanceLook look;
    if (compare) look = LookAtInstance(view(*fresh[i]));
    evidence_[fresh[i]->id].Add(At(*fresh[i]), look, std::move(said[i]), examples_,
                                config_.evidence);
  }
  for (auto& object : perception.objects) {
    const bool is_new = std::ranges::find(fresh, &object) != fresh.end();
    object.told = evidence_[object.id].told();
    if (object.told) MakeExample(view(object), is_new, object);
  }
  for (auto& object : perception.objects) {
    object.category = evidence_[object.id].Decide(examples_, config_.evidence);
    object.categorised = !object.category.probabilities.empty();
  }
  std::erase_if(evidence_, [this](const auto& entry) {
    return config_.remember && !memory_.Remembers(entry.first);
  });
}

/// The view that the user spoke of, and some that differ from it.
void Perceiver::MakeExample(const ObjectView& view, bool is_new, PerceivedObject& object) {
  const int n = examples_.Count(object.told->label_id);
  const bool more = is_new && evidence_[object.id].IsWhole(At(object));
  if (n >= config_.views_per_object || (n > 0 && !more)) return;
  const InstanceLook look = LookAtInstance(view);
  if (look.n_points == 0) return;
  examples_.Add({object.told->label_id, object.told->category, look});
  object.is_example = true;
}

std::vector<Categorisation> Perceiver::CategoriseEach(
    const RgbdImage& image, const Perception& perception,
    const std::vector<PerceivedObject*>& objects) const {
  std::vector<Categorisation> said(objects.size());
  std::atomic<size_t> next = 0;
  std::mutex failure_mutex;
  std::exception_ptr failure;
  auto work = [&] {
    try {
      for (size_t i; (i = next++) < objects.size();) {
        said[i] = categorise_({image, objects[i]->shape.pixels, perception.segmentation.table_C});
      }
    } catch (...) {  // must not leave a thread
      std::lock_guard lock(failure_mutex);
      failure = std::current_exception();
    }
  };
  const size_t n_threads = std::min<size_t>(config_.threads, objects.size());
  std::vector<std::jthread> others;
  for (size_t i = 1; i < n_threads; ++i) others.emplace_back(work);
  work();
  others.clear();  // joins
  if (failure) std::rethrow_exception(failure);
  return said;
}

std::optional<std::string> Perceiver::Tell(int id, const Told& told) {
  const auto known = evidence_.find(id);
  if (known == evidence_.end()) return std::nullopt;
  const std::optional<Told> before = known->second.told();
  std::string outdated;
  if (before && before->category != told.category && before->label_id != told.label_id)
    outdated = before->label_id;
  if (!outdated.empty()) Retract(outdated);
  const bool is_other = std::ranges::any_of(examples_.all(), [&](const ToldExample& e) {
    return e.label_id == told.label_id && e.category != told.category;
  });
  if (is_other) examples_.Remove(told.label_id);
  evidence_[id].Tell(told);
  return outdated;
}

void Perceiver::Retract(const std::string& label_id) {
  for (auto& [id, evidence] : evidence_) evidence.Retract(label_id);
  examples_.Remove(label_id);
}

}  // namespace beckon::perception
