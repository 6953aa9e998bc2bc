// Reading point clouds from files: PCD (ascii, binary, binary_compressed), PLY (ascii, binary
// little and big endian) and XYZ text.
#pragma once

#include <string>

#include "services/base/rgbd.h"

namespace beckon {

/// Reads a cloud; the format is told by the extension (.pcd .ply .xyz). Recognised fields: x y z,
/// rgb / rgba (PCD), red green blue (PLY), label; others are skipped. At most 50 million points.
/// Truncated, garbled, empty or all-NaN files fail with the file's name, what was expected and
/// where.
Result<Cloud> ReadCloudFile(const std::string& path);

/// Writes a binary PCD with fields x y z, rgba where colours are there, label where labels are.
Status WritePcdFile(const std::string& path, const Cloud& cloud);

}  // namespace beckon
