// Writing pictures as PNG files.
#pragma once

#include <string>
#include <vector>

#include "services/base/rgbd.h"

namespace beckon::capture {

/// Row-major pictures of width x height; each fails where the file cannot be written.
Status WriteColourPng(const std::string& path, int width, int height,
                      const std::vector<Rgb>& pixels);
Status WriteGreyPng(const std::string& path, int width, int height,
                    const std::vector<uint8_t>& pixels);
Status Write16BitPng(const std::string& path, int width, int height,
                     const std::vector<uint16_t>& pixels);

/// Depth in whole millimetres, 0 = none, cut at 65,535.
std::vector<uint16_t> Millimetres(const std::vector<float>& depth_m);

/// Makes a folder (and those above it); fails where that is not possible.
Status MakeFolder(const std::string& path);

/// Writes a text file.
Status WriteText(const std::string& path, const std::string& text);

}  // namespace beckon::capture
