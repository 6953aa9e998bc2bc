// Bounded little-endian reading and writing of the model's numbers, matrices and strings.
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace beckon::perception {

static_assert(std::endian::native == std::endian::little, "models are little-endian");

class ByteWriter {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T>
  void Write(T value) {
    const auto* p = reinterpret_cast<const uint8_t*>(&value);
    for (size_t i = 0; i < sizeof(T); ++i) bytes_.push_back(p[i]);
  }
  void Write(const std::string& text) {
    Write(static_cast<uint32_t>(text.size()));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }
  template <typename Matrix>
  void WriteMatrix(const Matrix& matrix) {
    Write(static_cast<uint32_t>(matrix.rows()));
    Write(static_cast<uint32_t>(matrix.cols()));
    const auto* p = reinterpret_cast<const uint8_t*>(matrix.data());
    bytes_.insert(bytes_.end(), p,
                  p + static_cast<size_t>(matrix.size()) * sizeof(typename Matrix::Scalar));
  }
  /// A section: four letters, length, content.
  void WriteSection(const char* tag, const ByteWriter& content) {
    bytes_.insert(bytes_.end(), tag, tag + 4);
    Write(static_cast<uint64_t>(content.bytes_.size()));
    bytes_.insert(bytes_.end(), content.bytes_.begin(), content.bytes_.end());
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

/// Reading past the end makes `ok` false for good and yields zeros.
class ByteReader {
 public:
  ByteReader(const uint8_t* data, size_t size) : at_(data), left_(size) {}

  template <typename T>
  T Read() {
    T value{};
    if (const uint8_t* p = Take(sizeof(T))) std::memcpy(&value, p, sizeof(T));
    return value;
  }
  std::string ReadText() {
    const auto size = Read<uint32_t>();
    const uint8_t* p = Take(size);
    return p ? std::string(p, p + size) : std::string();
  }
  template <typename Matrix>
  Matrix ReadMatrix() {
    using Scalar = typename Matrix::Scalar;
    const uint64_t rows = Read<uint32_t>();
    const uint64_t cols = Read<uint32_t>();
    constexpr uint64_t kMostSides = 1 << 24;
    if (rows > kMostSides || cols > kMostSides) ok_ = false;
    const uint8_t* p = ok_ ? Take(rows * cols * sizeof(Scalar)) : nullptr;
    if (!p) return Matrix();
    Matrix matrix(static_cast<int64_t>(rows), static_cast<int64_t>(cols));
    if (matrix.size() > 0) {
      std::memcpy(matrix.data(), p, static_cast<size_t>(matrix.size()) * sizeof(Scalar));
    }
    return matrix;
  }
  /// The content of the next section, which must have this tag.
  ByteReader ReadSection(const char* tag) {
    const uint8_t* name = Take(4);
    if (!name || std::memcmp(name, tag, 4) != 0) ok_ = false;
    const auto size = Read<uint64_t>();
    const uint8_t* p = Take(size);
    ByteReader section(p, p ? size : 0);
    section.ok_ = ok_;
    return section;
  }
  bool ok() const { return ok_; }
  /// Everything was there and everything was read.
  bool done() const { return ok_ && left_ == 0; }

 private:
  const uint8_t* Take(uint64_t size) {
    if (!ok_ || size > left_) {
      ok_ = false;
      return nullptr;
    }
    const uint8_t* p = at_;
    at_ += size;
    left_ -= size;
    return p;
  }

  const uint8_t* at_;
  size_t left_;
  bool ok_ = true;
};

}  // namespace beckon::perception
