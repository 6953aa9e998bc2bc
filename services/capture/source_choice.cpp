#include "services/capture/source_choice.h"

#include <filesystem>

#include "services/base/cloud_file.h"
#include "services/capture/description_json.h"
#include "services/capture/embedded_scene.h"
#include "services/capture/file_source.h"

namespace beckon::capture {
namespace {

namespace fs = std::filesystem;

bool IsFolder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool Exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

/// Hands out the image that was read for a check before it goes on.
class ReadAheadSource : public Source {
 public:
  ReadAheadSource(std::unique_ptr<Source> source, CapturedImage first)
      : source_(std::move(source)), first_(std::move(first)) {}
  Result<std::optional<CapturedImage>> Next() override {
    if (!first_) return source_->Next();
    auto first = std::move(first_);
    first_.reset();
    return first;
  }

 private:
  std::unique_ptr<Source> source_;
  std::optional<CapturedImage> first_;
};

Result<std::unique_ptr<Source>> OpenFolder(const Options& options) {
  auto files = ListCloudFiles(options.input);
  if (!files) return files.error();
  auto folder =
      std::make_unique<FolderSource>(*std::move(files), GivenIntrinsics(options), options.once);
  auto first = folder->Next();
  if (!first) return first.error();
  if (!first->has_value()) return Error{options.input + ": none of its cloud files can be read"};
  return std::unique_ptr<Source>(
      std::make_unique<ReadAheadSource>(std::move(folder), **std::move(first)));
}

/// Categories by label where 10 labels belong to one object and the first two tens are none.
Result<SceneDescription> DescribeLabelled(const std::string& path, const Cloud& cloud,
                                          const RgbdImage& image, std::vector<uint32_t> labels) {
  SceneDescription description;
  description.intrinsics = image.intrinsics;
  const fs::path file(path), categories_file = file.parent_path() / "categories.json";
  if (cloud.labels.empty() || !Exists(categories_file)) return description;
  const auto categories = ReadCategories(categories_file.string(), file.stem().string());
  if (!categories) return categories.error();
  if (categories->empty()) return description;
  for (uint32_t& label : labels) label = label < 20 ? 0 : label / 10;
  description.known = true;
  description.objects = DescribeLabels(image, labels, *categories);
  return description;
}

}  // namespace

Result<std::unique_ptr<Source>> OpenSource(const Options& options) {
  if (options.input.empty()) {
    CapturedImage image{
        std::make_shared<const RgbdImage>(RenderEmbeddedScene(options.embedded_seed).image),
        "embedded:" + std::to_string(options.embedded_seed)};
    return std::unique_ptr<Source>(std::make_unique<StillSource>(std::move(image)));
  }
  if (IsFolder(options.input)) return OpenFolder(options);
  auto image = ReadImageFile(options.input, GivenIntrinsics(options));
  if (!image) return image.error();
  return std::unique_ptr<Source>(std::make_unique<StillSource>(*std::move(image)));
}

Result<SceneDescription> DescribeInput(const Options& options) {
  if (options.input.empty()) return RenderEmbeddedScene(options.embedded_seed).description;
  if (IsFolder(options.input)) {
    return Error{options.input + ": the ground truth is told of one file, found a folder"};
  }
  const auto cloud = ReadCloudFile(options.input);
  if (!cloud) return cloud.error();
  const fs::path file(options.input);
  const fs::path beside = file.parent_path() / (file.stem().string() + "_truth.json");
  if (Exists(beside)) return ReadDescription(beside.string());
  const auto given = GivenIntrinsics(options);
  std::vector<uint32_t> labels;
  const auto image = ToImage(*cloud, given ? &*given : nullptr, &labels);
  if (!image) return Error{options.input + ": " + image.error().message};
  return DescribeLabelled(options.input, *cloud, *image, std::move(labels));
}

}  // namespace beckon::capture
