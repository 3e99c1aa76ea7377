#include "tools/testbed/input_error.h"

namespace polnav::testbed {

std::string InputError::Text(const std::string& file, int line, const std::string& key,
                             const std::string& message) {
  std::string text = file;
  if (line > 0) text.append(":").append(std::to_string(line));
  if (!text.empty()) text.append(": ");
  if (!key.empty()) text.append(key).append(": ");
  return text.append(message);
}

}  // namespace polnav::testbed
