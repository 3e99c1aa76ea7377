// What is in this picture file? As the estimators expect it, or the reason why it is not.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

namespace polnav::testbed {

struct LoadedPicture {
  cv::Mat image;        // empty when there is a problem
  std::string problem;  // names the file
};

// Grey, 8 bits; colours and deeper pictures are converted.
[[nodiscard]] LoadedPicture LoadGrey(const std::filesystem::path& file, const cv::Size& size);

// As it is: one channel of 8 bits, or of 16 when bits is more than that.
[[nodiscard]] LoadedPicture LoadMosaic(const std::filesystem::path& file, const cv::Size& size,
                                       int bits);

}  // namespace polnav::testbed
