// Images from cloud files and folders of them.
#pragma once

#include <vector>

#include "services/capture/source.h"

namespace beckon::capture {

/// A file as an image, through ReadCloudFile and ToImage; the file's name is part of every error.
Result<CapturedImage> ReadImageFile(const std::string& path,
                                    const std::optional<Intrinsics>& intrinsics);

/// The cloud files of a folder in natural order ("learn2" before "learn10").
Result<std::vector<std::string>> ListCloudFiles(const std::string& folder);

/// Whether `a` comes before `b` when runs of digits compare as numbers.
bool NaturallyBefore(const std::string& a, const std::string& b);

/// The files of a folder one after the other. A file that cannot be read is skipped; where none can
/// be, Next gives the first one's error.
class FolderSource : public Source {
 public:
  FolderSource(std::vector<std::string> files, std::optional<Intrinsics> intrinsics, bool once)
      : files_(std::move(files)), intrinsics_(intrinsics), once_(once) {}
  Result<std::optional<CapturedImage>> Next() override;

 private:
  std::vector<std::string> files_;
  std::optional<Intrinsics> intrinsics_;
  bool once_;
  size_t next_ = 0;
};

}  // namespace beckon::capture
