// Reads the files of an acoustic model. All numbers are little-endian.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>

#include "services/ui_bridge/speech/acoustic_model.h"

namespace beckon::ui_bridge::speech {
namespace {

constexpr float kLeastVariance = 1e-4F;
constexpr float kNever = -1e4F;  // logarithm of a transition that is not there
constexpr uint32_t kMostPhones = 1'000'000;

/// A file in memory, read from front to back. Past its end it gives zeros, and is not `good`.
class Bytes {
 public:
  explicit Bytes(const std::string& path) : path_(path) {
    std::ifstream file(path, std::ios::binary);
    good_ = file.good();
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
  }

  template <typename T>
  T Take() {
    T value{};
    if (at_ + sizeof(T) > bytes_.size()) return good_ = false, value;
    std::memcpy(&value, &bytes_[at_], sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string Text(size_t length) {
    if (length > bytes_.size() - at_) return good_ = false, std::string();
    at_ += length;
    return bytes_.substr(at_ - length, length);
  }
  /// Up to and without `mark`.
  std::string Until(const std::string& mark) {
    const size_t found = bytes_.find(mark, at_);
    if (found == std::string::npos) return good_ = false, std::string();
    std::string text = Text(found - at_);
    at_ += mark.size();
    return text;
  }
  size_t at() const { return at_; }
  bool good() const { return good_; }
  Error Wrong(const std::string& expected) const {
    return Error{path_ + ": expected " + expected +
                 ", as in pocketsphinx-en-us; install that package, or set [speech] model"};
  }

 private:
  std::string path_;
  std::string bytes_;
  size_t at_ = 0;
  bool good_ = false;
};

constexpr uint32_t kByteOrder = 0x11223344;

/// "s3", lines of attributes, "endhdr", a number that shows the order of bytes.
bool TakeHeader(Bytes& file) {
  file.Until("endhdr\n");
  return file.Take<uint32_t>() == kByteOrder;
}

}  // namespace

class AcousticModelReader {
 public:
  explicit AcousticModelReader(const std::string& folder) : folder_(folder) {}

  Result<AcousticModel> Read() {
    for (const auto step :
         {&AcousticModelReader::ReadTransitions, &AcousticModelReader::ReadDefinition,
          &AcousticModelReader::ReadDensities, &AcousticModelReader::ReadWeights}) {
      if (auto read = (this->*step)(); !read) return read.error();
    }
    return std::move(model_);
  }

 private:
  using Row = std::array<float, kStates + 1>;

  Status ReadTransitions() {
    Bytes file(folder_ + "/transition_matrices");
    const bool right = TakeHeader(file);
    n_transitions_ = file.Take<uint32_t>();
    if (!right || n_transitions_ > 1000 || file.Take<uint32_t>() != kStates ||
        file.Take<uint32_t>() != kStates + 1) {
      return file.Wrong("phones of three states");
    }
    file.Take<uint32_t>();  // numbers that follow
    for (uint32_t i = 0; i < n_transitions_; ++i) {
      PhoneModel model;
      for (size_t state = 0; state < kStates; ++state) {
        const Row row = file.Take<Row>();
        float sum = 0;
        for (const float x : row) sum += x;
        const auto log = [&](float x) { return x > 0 ? std::log(x / sum) : kNever; };
        model.stay[state] = log(row[state]);
        model.leave[state] = log(row[state + 1]);
      }
      transitions_.push_back(model);
    }
    return file.good() ? Status() : file.Wrong("a transition matrix of each phone");
  }

  /// Names of phones, then the tree of those between others, then which tied states each has.
  Status ReadDefinition() {
    Bytes file(folder_ + "/mdef");
    if (file.Text(4) != "BMDF" || file.Take<uint32_t>() != 1)
      return file.Wrong("a binary model definition of version 1");
    file.Text(file.Take<uint32_t>());
    const size_t names_from = file.at() + 10 * sizeof(uint32_t);
    const auto n_base = file.Take<uint32_t>();
    const auto n_phones = file.Take<uint32_t>();
    const auto n_states = file.Take<uint32_t>();
    file.Take<uint32_t>();  // tied states of the phones alone
    model_.senones_ = file.Take<uint32_t>();
    file.Take<uint32_t>();  // transition matrices
    const auto n_sequences = file.Take<uint32_t>();
    file.Take<uint32_t>();  // neighbours
    const auto n_nodes = file.Take<uint32_t>();
    file.Take<uint32_t>();  // silence
    if (!file.good() || n_states != kStates || n_base > 256 || n_phones > kMostPhones ||
        n_nodes > kMostPhones || n_sequences > kMostPhones || model_.senones_ > 65'535) {
      return file.Wrong("phones of three states");
    }
    for (uint32_t i = 0; i < n_base; ++i) names_.push_back(file.Until(std::string(1, '\0')));
    while ((file.at() - names_from) % 4 != 0) file.Take<uint8_t>();
    for (uint32_t i = 0; i < n_nodes; ++i) {
      model_.tree_.push_back({file.Take<int16_t>(), file.Take<int16_t>(), file.Take<int32_t>()});
      const auto& node = model_.tree_.back();
      const auto last = static_cast<int64_t>(node.down) + node.children;
      if (node.children < 0 || (node.children > 0 && (node.down < 0 || last > n_nodes)) ||
          (node.children == 0 && node.down >= static_cast<int64_t>(n_phones))) {
        return file.Wrong("a tree of phones");
      }
    }
    if (n_nodes < 4) return file.Wrong("a tree of phones");
    struct Entry {
      uint32_t sequence, transitions, attributes;
    };
    std::vector<Entry> entries;
    for (uint32_t i = 0; i < n_phones; ++i) entries.push_back(file.Take<Entry>());
    file.Take<uint32_t>();  // numbers that follow
    std::vector<std::array<uint16_t, kStates>> sequences;
    for (uint32_t i = 0; i < n_sequences; ++i)
      sequences.push_back(file.Take<std::array<uint16_t, kStates>>());
    model_.codebooks_.resize(n_base);
    std::vector<bool> used(model_.senones_);
    for (uint32_t i = 0; i < n_phones; ++i) {
      const Entry& entry = entries[i];
      if (entry.sequence >= n_sequences || entry.transitions >= n_transitions_)
        return file.Wrong("states of each phone");
      PhoneModel model = transitions_[entry.transitions];
      model.senones = sequences[entry.sequence];
      // The phone itself, or the one that it is a variant of.
      const uint32_t base = i < n_base ? i : (entry.attributes >> 8) & 0xff;
      for (const uint16_t senone : model.senones) {
        if (senone >= model_.senones_ || base >= n_base) return file.Wrong("states of each phone");
        if (!used[senone]) model_.codebooks_[base].senones.push_back(senone);
        used[senone] = true;
      }
      model_.models_.push_back(model);
    }
    return file.good() ? NamePhones(file) : file.Wrong("states of each phone");
  }

  Status NamePhones(const Bytes& file) {
    for (Phone phone = 0; phone <= kPhones; ++phone) {
      const auto name = std::ranges::find(names_, phone < kPhones ? kPhoneNames[phone] : "SIL");
      if (name == names_.end()) return file.Wrong("the 39 phones of English");
      model_.base_[phone] = static_cast<int>(name - names_.begin());
    }
    for (size_t i = 0; i < names_.size(); ++i) {
      if (names_[i].starts_with('+')) model_.noises_.push_back(model_.models_[i]);
    }
    return {};
  }

  Status ReadDensities() {
    Bytes means(folder_ + "/means");
    Bytes variances(folder_ + "/variances");
    for (Bytes* file : {&means, &variances}) {
      bool right = TakeHeader(*file) && file->Take<uint32_t>() == model_.codebooks_.size() &&
                   file->Take<uint32_t>() == kStreams;
      model_.densities_ = file->Take<uint32_t>();
      right = right && model_.densities_ >= AcousticModel::kTop && model_.densities_ <= 4096;
      for (int i = 0; i < kStreams; ++i) right = right && file->Take<uint32_t>() == kCepstrum;
      file->Take<uint32_t>();  // numbers that follow
      if (!right) return file->Wrong("a codebook of each phone for 3 times 13 coefficients");
    }
    for (auto& codebook : model_.codebooks_) {
      for (size_t s = 0; s < kStreams; ++s) {
        const size_t n = model_.densities_;
        codebook.means[s].resize(n * kCepstrum);
        codebook.half_precisions[s].resize(n * kCepstrum);
        codebook.offsets[s].resize(n);
        for (size_t d = 0; d < n; ++d) {
          const auto mean = means.Take<Cepstrum>();
          const auto variance = variances.Take<Cepstrum>();
          for (size_t i = 0; i < kCepstrum; ++i) {
            const float least = std::max(variance[i], kLeastVariance);
            codebook.means[s][i * n + d] = mean[i];
            codebook.half_precisions[s][i * n + d] = 0.5F / least;
            codebook.offsets[s][d] -= 0.5F * std::log(2 * std::numbers::pi_v<float> * least);
          }
        }
      }
    }
    if (!means.good()) return means.Wrong("means of all densities");
    return variances.good() ? Status() : variances.Wrong("variances of all densities");
  }

  /// Texts, each after its length, up to one of length 0; then the table.
  Status ReadWeights() {
    Bytes file(folder_ + "/sendump");
    for (uint32_t length = file.Take<uint32_t>(); file.good() && length > 0;
         length = file.Take<uint32_t>()) {
      const std::string text = file.Text(length);
      if (text.starts_with("cluster_count ") && std::strtol(&text[14], nullptr, 10) != 0)
        return file.Wrong("weights of a byte each");
    }
    const auto rows = file.Take<uint32_t>();
    const auto columns = file.Take<uint32_t>();
    if (!file.good() || rows != model_.densities_ || columns != model_.senones_)
      return file.Wrong("a weight of each density and tied state");
    for (auto& weights : model_.weights_) {
      const std::string bytes = file.Text(size_t{rows} * columns);
      weights.assign(bytes.begin(), bytes.end());
    }
    return file.good() ? Status() : file.Wrong("a weight of each density and tied state");
  }

  const std::string folder_;
  AcousticModel model_;
  uint32_t n_transitions_ = 0;
  std::vector<PhoneModel> transitions_;
  std::vector<std::string> names_;
};

Result<AcousticModel> AcousticModel::Load(const std::string& folder) {
  return AcousticModelReader(folder).Read();
}

}  // namespace beckon::ui_bridge::speech
