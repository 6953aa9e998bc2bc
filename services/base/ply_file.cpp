// PLY: a text header that declares elements of scalar and list properties, then their values as
// text or packed bytes of either order.
#include "services/base/ply_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "services/base/cloud_bytes.h"

namespace beckon::cloud {
namespace {

constexpr size_t kMaxElements = 64;
constexpr size_t kMaxProperties = 256;
constexpr uint64_t kMaxLinesOfHeader = 4096;

enum Role { kX, kY, kZ, kRed, kGreen, kBlue, kLabel, kRoles, kOther = kRoles };

struct Property {
  std::string_view name;
  Scalar type = Scalar::kF32;
  std::optional<Scalar> count_type;  // of a list
};

struct Element {
  std::string_view name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { kText, kLittle, kBig };

struct Header {
  Format format = Format::kText;
  std::vector<Element> elements;
  uint64_t columns = 0;  // obj_info num_cols, num_rows
  uint64_t rows = 0;
  size_t body = 0;
  uint64_t lines = 0;
};

std::optional<Scalar> TypeOf(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Scalar>, 16> kTypes{{{"char", Scalar::kI8},
                                                                        {"int8", Scalar::kI8},
                                                                        {"uchar", Scalar::kU8},
                                                                        {"uint8", Scalar::kU8},
                                                                        {"short", Scalar::kI16},
                                                                        {"int16", Scalar::kI16},
                                                                        {"ushort", Scalar::kU16},
                                                                        {"uint16", Scalar::kU16},
                                                                        {"int", Scalar::kI32},
                                                                        {"int32", Scalar::kI32},
                                                                        {"uint", Scalar::kU32},
                                                                        {"uint32", Scalar::kU32},
                                                                        {"float", Scalar::kF32},
                                                                        {"float32", Scalar::kF32},
                                                                        {"double", Scalar::kF64},
                                                                        {"float64", Scalar::kF64}}};
  for (const auto& [known, type] : kTypes) {
    if (name == known) return type;
  }
  return std::nullopt;
}

Role RoleOf(const Property& property) {
  constexpr std::array<std::pair<std::string_view, Role>, 10> kNames{{{"x", kX},
                                                                      {"y", kY},
                                                                      {"z", kZ},
                                                                      {"red", kRed},
                                                                      {"green", kGreen},
                                                                      {"blue", kBlue},
                                                                      {"diffuse_red", kRed},
                                                                      {"diffuse_green", kGreen},
                                                                      {"diffuse_blue", kBlue},
                                                                      {"label", kLabel}}};
  for (const auto& [known, role] : kNames) {
    if (property.name == known && !property.count_type) return role;
  }
  return kOther;
}

Status AddProperty(const std::vector<std::string_view>& words, Element& element) {
  const bool list = words.size() == 5 && words[1] == "list";
  const auto type = words.size() >= 3 ? TypeOf(words[list ? 3 : 1]) : std::nullopt;
  const auto count_type = list ? TypeOf(words[2]) : std::nullopt;
  if (!type || (list && (!count_type || IsFloat(*count_type))) || (!list && words.size() != 3)) {
    return Error{"expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\""};
  }
  if (element.properties.size() >= kMaxProperties) return Error{"more than 256 properties"};
  element.properties.push_back({words.back(), *type, count_type});
  return {};
}

Status ReadHeaderLine(const std::vector<std::string_view>& words, Header& header) {
  if (words[0] == "comment") return {};
  if (words[0] == "obj_info") {
    const auto value = words.size() == 3 ? ParseCount(words[2]) : std::nullopt;
    if (value && words[1] == "num_cols") header.columns = *value;
    if (value && words[1] == "num_rows") header.rows = *value;
    return {};
  }
  if (words[0] == "element") {
    const auto count = words.size() == 3 ? ParseCount(words[2]) : std::nullopt;
    if (!count || header.elements.size() >= kMaxElements) {
      return Error{"expected \"element NAME COUNT\", at most 64 of them"};
    }
    header.elements.push_back({words[1], *count, {}});
    return {};
  }
  if (words[0] == "property" && !header.elements.empty()) {
    return AddProperty(words, header.elements.back());
  }
  return Error{"expected element, property, comment or end_header, found " + Quote(words[0])};
}

Result<Header> ReadHeader(std::string_view bytes) {
  Scanner scanner(bytes, 0);
  Header header;
  const auto magic = scanner.Line();
  if (!magic || *magic != "ply") {
    return Error{"PLY header: expected \"ply\", found " + Quote(magic.value_or(""))};
  }
  bool has_format = false;
  for (;;) {
    const auto line = scanner.Line();
    if (!line || scanner.line() > kMaxLinesOfHeader) {
      return Error{"PLY header: expected \"end_header\", found none; the file is truncated"};
    }
    const auto words = Words(*line);
    if (words.empty()) continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      const std::string_view format = words.size() > 1 ? words[1] : "";
      has_format = true;
      if (format == "ascii") {
        header.format = Format::kText;
      } else if (format == "binary_little_endian") {
        header.format = Format::kLittle;
      } else if (format == "binary_big_endian") {
        header.format = Format::kBig;
      } else {
        return Error{
            "PLY header: expected format ascii, binary_little_endian or "
            "binary_big_endian, found " +
            Quote(format)};
      }
      continue;
    }
    if (auto status = ReadHeaderLine(words, header); !status) {
      return Error{"PLY header line " + std::to_string(scanner.line()) + ": " +
                   status.error().message};
    }
  }
  if (!has_format) return Error{"PLY header: expected a line \"format ...\", found none"};
  header.body = scanner.position();
  header.lines = scanner.line();
  return header;
}

/// Reads value after value, as text or bytes.
class Values {
 public:
  Values(Format format, std::string_view body, uint64_t line)
      : format_(format), body_(body), scanner_(body, line) {}

  bool text() const { return format_ == Format::kText; }
  uint64_t left() const { return body_.size() - (text() ? scanner_.position() : position_); }

  bool Next(Scalar type, double& value) {
    if (text()) {
      const auto number = ParseNumber(scanner_.Token());
      if (!number) return false;
      value = *number;
      return true;
    }
    const size_t size = SizeOf(type);
    if (body_.size() - position_ < size) return false;
    value = Load(body_.data() + position_, type, format_ == Format::kBig);
    position_ += size;
    return true;
  }

  std::string Where() const {
    return text() ? "line " + std::to_string(scanner_.line()) : "byte " + std::to_string(position_);
  }

 private:
  Format format_;
  std::string_view body_;
  Scanner scanner_;
  size_t position_ = 0;
};

/// Reads one row; `scalars` receives its scalar properties (NaN in place of lists).
bool ReadRow(const Element& element, Values& values, std::vector<double>& scalars) {
  for (size_t i = 0; i < element.properties.size(); ++i) {
    const Property& property = element.properties[i];
    scalars[i] = std::numeric_limits<double>::quiet_NaN();
    if (!property.count_type) {
      if (!values.Next(property.type, scalars[i])) return false;
      continue;
    }
    double count = 0;
    if (!values.Next(*property.count_type, count)) return false;
    if (!(count >= 0 && count <= static_cast<double>(values.left()))) return false;
    double ignored;
    for (uint64_t k = 0; k < static_cast<uint64_t>(count); ++k) {
      if (!values.Next(property.type, ignored)) return false;
    }
  }
  return true;
}

/// The fewest bytes a row can take.
uint64_t FewestBytes(const Element& element, bool text) {
  uint64_t bytes = 0;
  for (const Property& property : element.properties) {
    bytes += text ? 2 : SizeOf(property.count_type.value_or(property.type));
  }
  return bytes;
}

uint8_t ColourFrom(double value, Scalar type) {
  if (IsFloat(type)) value *= 255.0;  // floats are 0 .. 1
  return value >= 0 ? static_cast<uint8_t>(std::min(255.0, value + 0.5)) : 0;
}

void AddVertex(const Element& element, const std::vector<Role>& roles,
               const std::vector<double>& scalars, Cloud& cloud, bool colours, bool labels) {
  double at[kRoles + 1] = {};
  Rgb colour{};
  for (size_t i = 0; i < scalars.size(); ++i) {
    at[roles[i]] = scalars[i];
    if (roles[i] >= kRed && roles[i] <= kBlue) {
      colour[roles[i] - kRed] = ColourFrom(scalars[i], element.properties[i].type);
    }
  }
  cloud.points.push_back(MakePoint(at[kX], at[kY], at[kZ]));
  if (colours) cloud.colours.push_back(colour);
  if (labels) cloud.labels.push_back(MakeLabel(at[kLabel]));
}

Status CheckVertices(const Element& element, const std::vector<Role>& roles) {
  bool has[kRoles + 1] = {};
  for (Role role : roles) has[role] = true;
  if (!has[kX] || !has[kY] || !has[kZ])
    return Error{"PLY header: expected vertex properties x, y, z"};
  if (element.count == 0) return Error{"PLY header: the cloud is empty (0 vertices)"};
  if (element.count > kMaxPoints) return Error{"PLY header: more than 50 million vertices"};
  return {};
}

Status ReadElement(const Element& element, Values& values, Header& header, Cloud& cloud) {
  if (element.properties.empty()) return {};
  const uint64_t fewest = FewestBytes(element, values.text());
  if (element.count > (values.left() + 1) / fewest) {
    return Error{"PLY data: expected " + std::to_string(element.count) + " of " +
                 Quote(element.name) + ", of at least " + std::to_string(fewest) +
                 " bytes each, found " + std::to_string(values.left()) +
                 " bytes; the file is truncated"};
  }
  std::vector<Role> roles;
  for (const Property& property : element.properties) roles.push_back(RoleOf(property));
  const auto has = [&](Role role) {
    return std::find(roles.begin(), roles.end(), role) != roles.end();
  };
  const bool vertices = element.name == "vertex";
  const bool colours = has(kRed) && has(kGreen) && has(kBlue);
  const bool labels = has(kLabel);
  if (vertices) {
    if (auto status = CheckVertices(element, roles); !status) return status;
    cloud.points.reserve(element.count);
    if (colours) cloud.colours.reserve(element.count);
    if (labels) cloud.labels.reserve(element.count);
  }
  std::vector<double> scalars(element.properties.size());
  for (uint64_t row = 0; row < element.count; ++row) {
    if (!ReadRow(element, values, scalars)) {
      return Error{"PLY data, " + values.Where() + ": " + Quote(element.name) + " " +
                   std::to_string(row) + " of " + std::to_string(element.count) +
                   " is truncated or not a number"};
    }
    if (vertices) AddVertex(element, roles, scalars, cloud, colours, labels);
    if (element.name != "camera") continue;
    for (size_t i = 0; i < scalars.size(); ++i) {
      if (element.properties[i].name == "viewportx") header.columns = MakeLabel(scalars[i]);
      if (element.properties[i].name == "viewporty") header.rows = MakeLabel(scalars[i]);
    }
  }
  return {};
}

}  // namespace

Result<Cloud> ParsePly(std::string_view bytes) {
  auto header = ReadHeader(bytes);
  if (!header) return header.error();
  Cloud cloud;
  int vertex_elements = 0;
  for (const Element& element : header->elements) vertex_elements += element.name == "vertex";
  if (vertex_elements != 1) return Error{"PLY header: expected one element \"vertex\""};
  Values values(header->format, bytes.substr(header->body), header->lines + 1);
  const auto elements = header->elements;
  for (const Element& element : elements) {
    if (auto status = ReadElement(element, values, *header, cloud); !status) return status.error();
  }
  const uint64_t points = cloud.points.size();
  if (points == 0) return Error{"PLY header: the cloud is empty (0 vertices)"};
  cloud.width = static_cast<int>(points);
  uint64_t columns = header->columns, rows = header->rows;
  if (points == 640 * 480 && (columns == 0 || columns > points || columns * rows != points)) {
    columns = 640, rows = 480;
  }
  if (columns > 1 && rows > 1 && columns <= points && rows <= points && columns * rows == points) {
    cloud.width = static_cast<int>(columns);
    cloud.height = static_cast<int>(rows);
  }
  return cloud;
}

}  // namespace beckon::cloud
