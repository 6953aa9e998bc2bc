// A liblsl for tests: one stream, whose samples a test pushes through functions of its own.
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace {

struct Sample {
  std::vector<double> values;
  double stamp;
};

std::mutex mutex;
std::condition_variable pushed;
std::deque<Sample> samples;
std::string stream;
int channels = 0;
bool lost = false;
int inlets = 0;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

extern "C" {

void stub_offer(const char* name, int32_t n) {
  const std::lock_guard lock(mutex);
  stream = name;
  channels = n;
  lost = false;
}
void stub_lose() {
  const std::lock_guard lock(mutex);
  stream.clear();
  lost = true;
  pushed.notify_all();
}
void stub_push(const double* values, int32_t n, double age_s) {
  const std::lock_guard lock(mutex);
  samples.push_back({std::vector<double>(values, values + n), Now() - age_s});
  pushed.notify_all();
}
int32_t stub_inlets() {
  const std::lock_guard lock(mutex);
  return inlets;
}

int32_t lsl_resolve_byprop(void** found, uint32_t, const char* property, const char* value, int32_t,
                           double timeout_s) {
  std::unique_lock lock(mutex);
  if (std::strcmp(property, "name") == 0 && stream == value && !stream.empty()) {
    found[0] = &stream;
    return 1;
  }
  pushed.wait_for(lock, std::chrono::duration<double>(timeout_s / 10));
  return 0;
}
int32_t lsl_get_channel_count(void*) {
  const std::lock_guard lock(mutex);
  return channels;
}
void lsl_destroy_streaminfo(void*) {}
void* lsl_create_inlet(void*, int32_t, int32_t, int32_t) {
  const std::lock_guard lock(mutex);
  ++inlets;
  return &inlets;
}
uint32_t lsl_set_postprocessing(void*, uint32_t) { return 0; }
double lsl_pull_sample_d(void*, double* values, int32_t n, double timeout_s, int32_t* error) {
  std::unique_lock lock(mutex);
  pushed.wait_for(lock, std::chrono::duration<double>(timeout_s),
                  [] { return lost || !samples.empty(); });
  *error = lost ? -2 : 0;
  if (lost || samples.empty()) return 0;
  const Sample sample = samples.front();
  samples.pop_front();
  for (int32_t i = 0; i < n; ++i)
    values[i] = i < static_cast<int32_t>(sample.values.size()) ? sample.values[i] : 0;
  return sample.stamp;
}
void lsl_destroy_inlet(void*) {
  const std::lock_guard lock(mutex);
  --inlets;
}
double lsl_local_clock() { return Now(); }
}
