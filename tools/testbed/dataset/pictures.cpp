#include "tools/testbed/dataset/pictures.h"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

namespace polnav::testbed {
namespace {

LoadedPicture Load(const std::filesystem::path& file, const cv::Size& size, int flags) {
  const auto problem = [&](const std::string& text) {
    return LoadedPicture{.image = {}, .problem = file.string() + ": " + text};
  };
  if (!std::filesystem::is_regular_file(file)) return problem("no such file");
  cv::Mat image;
  try {
    image = cv::imread(file.string(), flags);
  } catch (const cv::Exception&) {
    // Also what OpenCV thinks of an absurd size in a broken header.
  }
  if (image.empty()) return problem("not a readable picture");
  if (image.size() != size) {
    return problem(fmt::format("{} x {} px, expected {} x {}", image.cols, image.rows, size.width,
                               size.height));
  }
  return {.image = image, .problem = ""};
}

}  // namespace

LoadedPicture LoadGrey(const std::filesystem::path& file, const cv::Size& size) {
  return Load(file, size, cv::IMREAD_GRAYSCALE);
}

LoadedPicture LoadMosaic(const std::filesystem::path& file, const cv::Size& size, int bits) {
  LoadedPicture loaded = Load(file, size, cv::IMREAD_UNCHANGED);
  const int type = bits > 8 ? CV_16UC1 : CV_8UC1;
  if (!loaded.image.empty() && loaded.image.type() != type) {
    loaded.image.release();
    loaded.problem =
        fmt::format("{}: expected one channel of {} bits", file.string(), bits > 8 ? 16 : 8);
  }
  return loaded;
}

}  // namespace polnav::testbed
