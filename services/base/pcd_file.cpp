// PCD: a text header that declares fields of any size, type and count, then rows of text or of
// packed bytes, or LZF-compressed columns.
#include "services/base/pcd_file.h"

#include <liblzf/lzf.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "services/base/cloud_bytes.h"

namespace beckon::cloud {
namespace {

constexpr uint64_t kMaxFields = 256;
constexpr uint64_t kMaxRowBytes = 1 << 20;
constexpr uint64_t kMaxRowsOfHeader = 256;

enum Role { kX, kY, kZ, kPackedColour, kLabel, kRoles, kOther = kRoles };

struct Field {
  Role role = kOther;
  Scalar type = Scalar::kF32;
  uint64_t count = 1;         // scalars a point
  uint64_t offset = 0;        // bytes in a row
  uint64_t first_column = 0;  // scalars before it in a row
};

struct Header {
  std::vector<Field> fields;
  uint64_t width = 0;
  uint64_t height = 1;
  uint64_t points = 0;
  uint64_t row_bytes = 0;
  uint64_t row_scalars = 0;
  std::string_view data;  // ascii, binary, binary_compressed
  size_t body = 0;        // where the data begins
  uint64_t lines = 0;
};

Role RoleOf(std::string_view name) {
  if (name == "x") return kX;
  if (name == "y") return kY;
  if (name == "z") return kZ;
  if (name == "rgb" || name == "rgba") return kPackedColour;
  if (name == "label") return kLabel;
  return kOther;
}

std::optional<Scalar> TypeOf(char letter, uint64_t size) {
  const int log_size = size == 1 ? 0 : size == 2 ? 1 : size == 4 ? 2 : size == 8 ? 3 : -1;
  if (log_size < 0) return std::nullopt;
  constexpr std::array kSigned{Scalar::kI8, Scalar::kI16, Scalar::kI32, Scalar::kI64};
  constexpr std::array kUnsigned{Scalar::kU8, Scalar::kU16, Scalar::kU32, Scalar::kU64};
  if (letter == 'I') return kSigned[log_size];
  if (letter == 'U') return kUnsigned[log_size];
  if (letter == 'F' && log_size >= 2) return log_size == 2 ? Scalar::kF32 : Scalar::kF64;
  return std::nullopt;
}

/// The header's lines by their keyword.
struct Entries {
  std::vector<std::string_view> names, sizes, types, counts, width, height, points, data;

  std::vector<std::string_view>* Find(std::string_view key) {
    if (key == "FIELDS" || key == "COLUMNS") return &names;
    if (key == "SIZE") return &sizes;
    if (key == "TYPE") return &types;
    if (key == "COUNT") return &counts;
    if (key == "WIDTH") return &width;
    if (key == "HEIGHT") return &height;
    if (key == "POINTS") return &points;
    if (key == "DATA") return &data;
    return nullptr;
  }
};

Status ReadEntries(std::string_view bytes, Entries& entries, Header& header) {
  Scanner scanner(bytes, 0);
  while (entries.data.empty()) {
    const auto line = scanner.Line();
    if (!line || scanner.line() > kMaxRowsOfHeader) {
      return Error{
          "PCD header: expected a line \"DATA ...\", found none; the file is truncated or "
          "no PCD file"};
    }
    std::vector<std::string_view> words = Words(*line);
    if (words.empty() || words[0][0] == '#') continue;
    const std::string_view key = words[0];
    auto* entry = entries.Find(key);
    if (entry == nullptr && key != "VERSION" && key != "VIEWPOINT") {
      return Error{"PCD header line " + std::to_string(scanner.line()) +
                   ": expected a keyword such as FIELDS, found " + Quote(key)};
    }
    if (words.size() < 2) {
      return Error{"PCD header line " + std::to_string(scanner.line()) + ": " + Quote(key) +
                   " without a value"};
    }
    words.erase(words.begin());
    if (entry != nullptr) *entry = std::move(words);
  }
  header.data = entries.data[0];
  header.body = scanner.position();
  header.lines = scanner.line();
  return {};
}

Status ReadFields(const Entries& entries, Header& header) {
  const size_t n = entries.names.size();
  if (n == 0 || n > kMaxFields) {
    return Error{"PCD header: expected 1 .. 256 FIELDS, found " + std::to_string(n)};
  }
  if (entries.sizes.size() != n || entries.types.size() != n ||
      (!entries.counts.empty() && entries.counts.size() != n)) {
    return Error{"PCD header: expected SIZE, TYPE and COUNT for each of the " + std::to_string(n) +
                 " FIELDS"};
  }
  for (size_t i = 0; i < n; ++i) {
    const auto size = ParseCount(entries.sizes[i]);
    const auto type =
        size && entries.types[i].size() == 1 ? TypeOf(entries.types[i][0], *size) : std::nullopt;
    const auto count = entries.counts.empty() ? 1 : ParseCount(entries.counts[i]);
    if (!type || !count || *count > kMaxRowBytes) {
      return Error{"PCD header: field " + Quote(entries.names[i]) +
                   ": expected SIZE 1, 2, 4 or 8, TYPE I, U or F and a COUNT, found other"};
    }
    Field field{RoleOf(entries.names[i]), *type, *count, header.row_bytes, header.row_scalars};
    if (field.role != kOther && field.count != 1) {
      return Error{"PCD header: field " + Quote(entries.names[i]) + ": expected COUNT 1"};
    }
    if (field.role == kPackedColour && SizeOf(*type) != 4) {
      return Error{"PCD header: field " + Quote(entries.names[i]) + ": expected SIZE 4"};
    }
    header.row_bytes += SizeOf(*type) * *count;
    header.row_scalars += *count;
    header.fields.push_back(field);
    if (header.row_bytes > kMaxRowBytes) {
      return Error{"PCD header: a point of over 1 MB: the header is damaged"};
    }
  }
  return {};
}

Status ReadSize(const Entries& entries, Header& header) {
  const auto number = [](const std::vector<std::string_view>& words) {
    return words.empty() ? std::nullopt : ParseCount(words[0]);
  };
  const auto width = number(entries.width);
  const auto height = number(entries.height);
  const auto points = number(entries.points);
  const auto garbled = [](const auto& words, const auto& count) {
    return !words.empty() && !count;
  };
  if ((!width && !points) || garbled(entries.width, width) || garbled(entries.height, height) ||
      garbled(entries.points, points))
    return Error{"PCD header: expected WIDTH, HEIGHT and POINTS as counts"};
  header.width = width ? *width : *points;
  header.height = height ? *height : 1;
  if (header.width > kMaxPoints || header.height > kMaxPoints ||
      header.width * header.height > kMaxPoints) {
    return Error{"PCD header: more than 50 million points"};
  }
  header.points = header.width * header.height;
  if (points && *points != header.points) {
    return Error{"PCD header: POINTS is " + std::to_string(*points) + ", WIDTH x HEIGHT is " +
                 std::to_string(header.points)};
  }
  if (header.points == 0) return Error{"PCD header: the cloud is empty (0 points)"};
  return {};
}

Result<Header> ReadHeader(std::string_view bytes) {
  Entries entries;
  Header header;
  if (auto status = ReadEntries(bytes, entries, header); !status) return status.error();
  if (auto status = ReadFields(entries, header); !status) return status.error();
  if (auto status = ReadSize(entries, header); !status) return status.error();
  bool has[kRoles + 1] = {};
  for (const Field& field : header.fields) has[field.role] = true;
  if (!has[kX] || !has[kY] || !has[kZ]) return Error{"PCD header: expected fields x, y and z"};
  return header;
}

Error Truncated(const Header& header, uint64_t expected, uint64_t found) {
  return Error{"PCD data: expected at least " + std::to_string(expected) + " bytes for " +
               std::to_string(header.points) + " points, found " + std::to_string(found) +
               "; the file is truncated"};
}

Rgb Unpack(uint32_t packed) {
  return {static_cast<uint8_t>(packed >> 16), static_cast<uint8_t>(packed >> 8),
          static_cast<uint8_t>(packed)};
}

Cloud MakeCloud(const Header& header) {
  Cloud cloud;
  cloud.width = static_cast<int>(header.width);
  cloud.height = static_cast<int>(header.height);
  cloud.points.resize(header.points);
  for (const Field& field : header.fields) {
    if (field.role == kPackedColour) cloud.colours.resize(header.points);
    if (field.role == kLabel) cloud.labels.resize(header.points);
  }
  return cloud;
}

/// Fills the cloud from bytes in rows, or, where `columns`, field after field.
Cloud FromBytes(const Header& header, const char* data, bool columns) {
  Cloud cloud = MakeCloud(header);
  const Field* fields[kRoles + 1] = {};
  for (const Field& field : header.fields) fields[field.role] = &field;
  const auto at = [&](const Field& field, uint64_t i) {
    return columns ? data + field.offset * header.points + i * SizeOf(field.type)
                   : data + i * header.row_bytes + field.offset;
  };
  const auto value = [&](Role role, uint64_t i) {
    return Load(at(*fields[role], i), fields[role]->type);
  };
  for (uint64_t i = 0; i < header.points; ++i) {
    cloud.points[i] = MakePoint(value(kX, i), value(kY, i), value(kZ, i));
    if (fields[kPackedColour] != nullptr) {
      uint32_t packed;
      std::memcpy(&packed, at(*fields[kPackedColour], i), sizeof packed);
      cloud.colours[i] = Unpack(packed);
    }
    if (fields[kLabel] != nullptr) cloud.labels[i] = MakeLabel(value(kLabel, i));
  }
  return cloud;
}

Result<Cloud> FromCompressed(const Header& header, std::string_view body) {
  if (body.size() < 8) return Truncated(header, 8, body.size());
  uint32_t compressed, raw;
  std::memcpy(&compressed, body.data(), 4);
  std::memcpy(&raw, body.data() + 4, 4);
  if (raw != header.points * header.row_bytes) {
    return Error{"PCD data: expected " + std::to_string(header.points * header.row_bytes) +
                 " bytes after decompression, the file says " + std::to_string(raw)};
  }
  if (compressed > body.size() - 8) return Truncated(header, compressed + 8ULL, body.size());
  constexpr uint64_t kBestRatio = 100;  // LZF makes at most 264 bytes of 3
  if (raw > kBestRatio * compressed) return Error{"PCD data: the compressed data is damaged"};
  std::vector<char> data(raw);
  if (lzf_decompress(body.data() + 8, compressed, data.data(), raw) != raw) {
    return Error{"PCD data: the compressed data is damaged"};
  }
  return FromBytes(header, data.data(), true);
}

/// Colours in text are the packed integer, or a float whose bits (some writers: whose value) are
/// it.
uint32_t PackedFromText(double value, Scalar type) {
  constexpr double kPackedEnd = 1 << 24;
  if (type == Scalar::kF32 && !(value >= 1 && value < kPackedEnd)) {
    return std::bit_cast<uint32_t>(static_cast<float>(value));
  }
  if (type == Scalar::kI32 && value < 0 && value >= -2147483648.0) {
    return static_cast<uint32_t>(static_cast<int32_t>(value));
  }
  return MakeLabel(value);
}

Result<Cloud> FromText(const Header& header, std::string_view body) {
  const uint64_t fewest = 2 * header.points * header.row_scalars - 1;
  if (body.size() < fewest) return Truncated(header, fewest, body.size());
  Cloud cloud = MakeCloud(header);
  std::vector<const Field*> roles(header.row_scalars, nullptr);
  for (const Field& field : header.fields) {
    if (field.role != kOther) roles[field.first_column] = &field;
  }
  Scanner scanner(body, header.lines + 1);
  for (uint64_t i = 0; i < header.points; ++i) {
    double values[kRoles] = {};
    for (const Field* field : roles) {
      const std::string_view token = scanner.Token();
      const auto value = ParseNumber(token);
      if (!value) {
        return Error{"PCD data line " + std::to_string(scanner.line()) + ": expected a number, " +
                     (token.empty() ? "found the end: the file is truncated at point " +
                                          std::to_string(i) + " of " + std::to_string(header.points)
                                    : "found " + Quote(token))};
      }
      if (field == nullptr) continue;
      values[field->role] =
          field->role == kPackedColour ? PackedFromText(*value, field->type) : *value;
    }
    cloud.points[i] = MakePoint(values[kX], values[kY], values[kZ]);
    if (!cloud.colours.empty())
      cloud.colours[i] = Unpack(static_cast<uint32_t>(values[kPackedColour]));
    if (!cloud.labels.empty()) cloud.labels[i] = MakeLabel(values[kLabel]);
  }
  return cloud;
}

}  // namespace

Result<Cloud> ParsePcd(std::string_view bytes) {
  const auto header = ReadHeader(bytes);
  if (!header) return header.error();
  const std::string_view body = bytes.substr(header->body);
  if (header->data == "ascii") return FromText(*header, body);
  if (header->data == "binary_compressed") return FromCompressed(*header, body);
  if (header->data != "binary") {
    return Error{"PCD header: expected DATA ascii, binary or binary_compressed, found " +
                 Quote(header->data)};
  }
  const uint64_t expected = header->points * header->row_bytes;
  if (body.size() < expected) return Truncated(*header, expected, body.size());
  return FromBytes(*header, body.data(), false);
}

std::string FormatPcd(const Cloud& cloud) {
  const bool colours = !cloud.colours.empty();
  const bool labels = !cloud.labels.empty();
  const auto column = [&](const char* always, const char* colour, const char* label) {
    return std::string(always) + (colours ? colour : "") + (labels ? label : "") + "\n";
  };
  const std::string points = std::to_string(cloud.points.size());
  std::string bytes = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
  bytes += column("FIELDS x y z", " rgba", " label") + column("SIZE 4 4 4", " 4", " 4") +
           column("TYPE F F F", " U", " U") + column("COUNT 1 1 1", " 1", " 1");
  bytes += "WIDTH " + std::to_string(cloud.width) + "\nHEIGHT " + std::to_string(cloud.height) +
           "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA binary\n";
  bytes.reserve(bytes.size() + cloud.points.size() * 20);
  for (size_t i = 0; i < cloud.points.size(); ++i) {
    bytes.append(reinterpret_cast<const char*>(cloud.points[i].data()), 12);
    if (colours) {
      const auto [r, g, b] = cloud.colours[i];
      const uint32_t packed = 0xff000000u | static_cast<uint32_t>(r) << 16 | g << 8 | b;
      bytes.append(reinterpret_cast<const char*>(&packed), 4);
    }
    if (labels) bytes.append(reinterpret_cast<const char*>(&cloud.labels[i]), 4);
  }
  return bytes;
}

}  // namespace beckon::cloud
