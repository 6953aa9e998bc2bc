// The model's sections.
#include "services/perception/model_file.h"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "services/perception/model_bytes.h"

namespace beckon::perception {
namespace {

constexpr char kMagic[] = {'B', 'E', 'C', 'K', 'O', 'N', 'C', 'M'};
constexpr size_t kHeader = sizeof(kMagic) + 4 + 8 + 4;  // version, length, CRC
constexpr uint32_t kMostCues = 32;
constexpr uint32_t kMostDeciders = 64;

uint32_t Crc(const uint8_t* data, size_t size) {
  return static_cast<uint32_t>(crc32(0, data, static_cast<uInt>(size)));
}

ByteWriter Pack(const SvmClassifier& svm) {
  ByteWriter out;
  out.Write(svm.gamma);
  out.WriteMatrix(svm.vectors);
  out.WriteMatrix(svm.coefficients);
  for (size_t c = 0; c < svm.rho.size(); ++c) {
    out.Write(svm.rho[c]);
    out.Write(svm.sigmoids[c].a);
    out.Write(svm.sigmoids[c].b);
  }
  return out;
}

SvmClassifier UnpackSvm(ByteReader in, size_t classes, bool& ok) {
  SvmClassifier svm;
  svm.gamma = in.Read<float>();
  svm.vectors = in.ReadMatrix<decltype(svm.vectors)>();
  svm.coefficients = in.ReadMatrix<decltype(svm.coefficients)>();
  for (size_t c = 0; c < classes; ++c) {
    svm.rho.push_back(in.Read<float>());
    const float a = in.Read<float>();
    svm.sigmoids.push_back({a, in.Read<float>()});
  }
  ok = ok && in.done();
  return svm;
}

CueModel UnpackCue(ByteReader in, size_t classes, bool& ok) {
  CueModel cue;
  cue.name = in.ReadText();
  cue.encoder.vocabulary = in.ReadMatrix<Descriptors>();
  cue.encoder.quantiles = in.ReadMatrix<Descriptors>();
  cue.classifier = UnpackSvm(in.ReadSection("SVM "), classes, ok);
  ok = ok && in.done();
  return cue;
}

Decider UnpackDecider(ByteReader in, size_t classes, bool& ok) {
  Decider decider;
  const uint32_t cues = std::min(in.Read<uint32_t>(), kMostCues);
  for (uint32_t i = 0; i < cues; ++i) decider.cues.push_back(in.Read<uint32_t>());
  if (in.Read<uint8_t>() != 0) {
    for (uint32_t i = 0; i < cues; ++i) decider.weights.push_back(in.Read<float>());
  }
  decider.temperature = in.Read<float>();
  decider.threshold = in.Read<float>();
  for (SvmClassifier* svm : {&decider.svm, &decider.correction}) {
    if (in.Read<uint8_t>() != 0) *svm = UnpackSvm(in.ReadSection("SVM "), classes, ok);
  }
  ok = ok && in.done();
  return decider;
}

ByteWriter Pack(const Decider& decider) {
  ByteWriter out;
  out.Write(static_cast<uint32_t>(decider.cues.size()));
  for (const uint32_t cue : decider.cues) out.Write(cue);
  out.Write(static_cast<uint8_t>(!decider.weights.empty()));
  for (const float weight : decider.weights) out.Write(weight);
  out.Write(decider.temperature);
  out.Write(decider.threshold);
  for (const SvmClassifier* svm : {&decider.svm, &decider.correction}) {
    const bool learnt = svm->classes() > 0;
    out.Write(static_cast<uint8_t>(learnt));
    if (learnt) out.WriteSection("SVM ", Pack(*svm));
  }
  return out;
}

/// False where the sections do not follow the format.
bool Unpack(ByteReader in, Model& model) {
  bool ok = true;
  ByteReader head = in.ReadSection("HEAD");
  const uint32_t categories = std::min(head.Read<uint32_t>(), kMostCategories);
  for (uint32_t i = 0; i < categories; ++i) model.categories.push_back(head.ReadText());
  model.unknown_prior = head.Read<float>();
  model.seed = head.Read<uint64_t>();
  model.description = head.ReadText();
  const uint32_t cues = std::min(head.Read<uint32_t>(), kMostCues);
  const uint32_t deciders = std::min(head.Read<uint32_t>(), kMostDeciders);
  ok = head.done();
  for (uint32_t i = 0; ok && i < cues; ++i) {
    model.cues.push_back(UnpackCue(in.ReadSection("CUE "), categories, ok));
  }
  for (uint32_t i = 0; ok && i < deciders; ++i) {
    model.deciders.push_back(UnpackDecider(in.ReadSection("DECI"), categories, ok));
  }
  return ok && in.done();
}

/// The sections; empty where they are not what their length says.
std::vector<uint8_t> Inflate(const uint8_t* data, size_t size) {
  ByteReader head(data, size);
  const auto length = head.Read<uint64_t>();
  if (!head.ok() || length > kMostModelBytes) return {};
  std::vector<uint8_t> sections(length);
  uLongf written = length;
  uLong read = size - sizeof(length);
  const int result = uncompress2(sections.data(), &written, data + sizeof(length), &read);
  if (result != Z_OK || written != length || read != size - sizeof(length)) return {};
  return sections;
}

Error Refuse(const std::string& name, const std::string& why) {
  return Error{name + ": " + why + "; rebuild the model with beckon-train --data DIR --model " +
               name};
}

}  // namespace

std::vector<uint8_t> ModelSections(const Model& model) {
  ByteWriter head;
  head.Write(static_cast<uint32_t>(model.categories.size()));
  for (const std::string& category : model.categories) head.Write(category);
  head.Write(model.unknown_prior);
  head.Write(model.seed);
  head.Write(model.description);
  head.Write(static_cast<uint32_t>(model.cues.size()));
  head.Write(static_cast<uint32_t>(model.deciders.size()));
  ByteWriter body;
  body.WriteSection("HEAD", head);
  for (const CueModel& cue : model.cues) {
    ByteWriter part;
    part.Write(cue.name);
    part.WriteMatrix(cue.encoder.vocabulary);
    part.WriteMatrix(cue.encoder.quantiles);
    part.WriteSection("SVM ", Pack(cue.classifier));
    body.WriteSection("CUE ", part);
  }
  for (const Decider& decider : model.deciders) body.WriteSection("DECI", Pack(decider));

  return body.bytes();
}

std::vector<uint8_t> WrapSections(const std::vector<uint8_t>& sections) {
  uLongf size = compressBound(sections.size());
  std::vector<uint8_t> packed(size);
  compress2(packed.data(), &size, sections.data(), sections.size(), Z_DEFAULT_COMPRESSION);
  packed.resize(size);
  ByteWriter body;
  body.Write(static_cast<uint64_t>(sections.size()));
  ByteWriter file;
  for (const char letter : kMagic) file.Write(letter);
  file.Write(kModelVersion);
  file.Write(static_cast<uint64_t>(body.bytes().size() + packed.size()));
  std::vector<uint8_t> rest = body.bytes();
  rest.insert(rest.end(), packed.begin(), packed.end());
  file.Write(Crc(rest.data(), rest.size()));
  std::vector<uint8_t> bytes = file.bytes();
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

std::vector<uint8_t> SerialiseModel(const Model& model) {
  return WrapSections(ModelSections(model));
}

Result<Model> ParseModel(const std::vector<uint8_t>& bytes, const std::string& name) {
  if (bytes.size() < kHeader || !std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin())) {
    return Refuse(name, "not a model of beckon-train");
  }
  ByteReader header(bytes.data() + sizeof(kMagic), kHeader - sizeof(kMagic));
  const auto version = header.Read<uint32_t>();
  const auto size = header.Read<uint64_t>();
  const auto crc = header.Read<uint32_t>();
  if (version != kModelVersion) {
    return Refuse(name, "a model of format " + std::to_string(version) +
                            ", but this program reads format " + std::to_string(kModelVersion));
  }
  if (size != bytes.size() - kHeader) {
    return Refuse(name, "truncated: expected " + std::to_string(size) +
                            " bytes after the header, found " +
                            std::to_string(bytes.size() - kHeader));
  }
  if (Crc(bytes.data() + kHeader, size) != crc) {
    return Refuse(name, "damaged: its checksum does not match");
  }
  const std::vector<uint8_t> sections = Inflate(bytes.data() + kHeader, size);
  Model model;
  if (!Unpack(ByteReader(sections.data(), sections.size()), model)) {
    return Refuse(name, "garbled: its sections do not follow the format");
  }
  if (Status status = Validate(model); !status) {
    return Refuse(name, "unusable: " + status.error().message);
  }
  for (CueModel& cue : model.cues) cue.classifier.Prepare();
  for (Decider& decider : model.deciders) {
    decider.svm.Prepare();
    decider.correction.Prepare();
  }
  return model;
}

Result<Model> ReadModelFile(const std::string& path) {
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (error) {
    return Error{path + ": cannot read the categories' model (" + error.message() +
                 "); give one with --model, or make one with beckon-train"};
  }
  if (size > kMostModelBytes) return Refuse(path, "larger than any model (64 MB)");
  std::vector<uint8_t> bytes(size);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!file) return Error{path + ": cannot read the categories' model; check its permissions"};
  return ParseModel(bytes, path);
}

Status WriteModelFile(const std::string& path, const Model& model) {
  if (Status status = Validate(model); !status) {
    return Error{path + ": not written: " + status.error().message};
  }
  const std::vector<uint8_t> bytes = SerialiseModel(model);
  const std::string part = path + ".part";
  {
    std::ofstream file(part, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) return Error{path + ": cannot write the model; check folder, permissions and space"};
  }
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) return Error{path + ": cannot put the model in place (" + error.message() + ")"};
  return {};
}

}  // namespace beckon::perception
