// What did the user get wrong, and where?
//
// Thrown for bad input only and caught once in main, which prints it and exits with 2. A broken
// contract inside Polnav is a std::logic_error instead.
#pragma once

#include <stdexcept>
#include <string>

namespace polnav::testbed {

class InputError : public std::runtime_error {
 public:
  // file, key: may be empty; line counts from 1, 0 when there is none.
  InputError(const std::string& file, int line, const std::string& key, const std::string& message)
      : std::runtime_error(Text(file, line, key, message)), file_(file), line_(line), key_(key) {}
  explicit InputError(const std::string& message) : InputError("", 0, "", message) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] const std::string& key() const { return key_; }

 private:
  static std::string Text(const std::string& file, int line, const std::string& key,
                          const std::string& message);

  std::string file_;
  int line_ = 0;
  std::string key_;
};

}  // namespace polnav::testbed
