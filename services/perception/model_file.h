// The model as a file: a magic word, the format's version, length and CRC-32 of the rest, which is
// tagged sections, deflated. Little-endian on every machine, no text that a locale could change.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/perception/model.h"

namespace beckon::perception {

constexpr uint32_t kModelVersion = 3;
constexpr size_t kMostModelBytes = 64 << 20;  // before deflation too

/// Same model and zlib, same bytes.
std::vector<uint8_t> SerialiseModel(const Model& model);

/// The two steps of it: sections, and the file around them.
std::vector<uint8_t> ModelSections(const Model& model);
std::vector<uint8_t> WrapSections(const std::vector<uint8_t>& sections);

/// Never reads beyond `bytes`, never allocates more than a small multiple of kMostModelBytes.
/// Refuses what is truncated, altered, of another version, or fails Validate. `name` stands for the
/// file in messages.
Result<Model> ParseModel(const std::vector<uint8_t>& bytes, const std::string& name);

/// At most kMostModelBytes.
Result<Model> ReadModelFile(const std::string& path);
/// Refuses what ParseModel would. Writes beside and renames, so that a reader never sees half a
/// model.
Status WriteModelFile(const std::string& path, const Model& model);

}  // namespace beckon::perception
