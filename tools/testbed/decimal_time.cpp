#include "tools/testbed/decimal_time.h"

#include <algorithm>
#include <charconv>
#include <string>

namespace polnav::testbed {
namespace {

constexpr int kDigitsBelowSecond = 9;
constexpr int kExponentMax = 40;

template <typename Integer>
std::optional<Integer> ParseInteger(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Integer value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size() && !text.empty();
  return whole ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<nav::TimeNs> ParseDecimalSeconds(std::string_view text) {
  int exponent = 0;
  if (const std::size_t e = text.find_first_of("eE"); e != std::string_view::npos) {
    const std::optional<int> given = ParseInteger<int>(text.substr(e + 1));
    if (!given || *given < -kExponentMax || *given > kExponentMax) return std::nullopt;
    exponent = *given;
    text = text.substr(0, e);
  }
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  const std::size_t dot = std::min(text.find('.'), text.size());
  std::string digits(text.substr(0, dot));
  digits += text.substr(std::min(dot + 1, text.size()));
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  // Where nanoseconds end among the digits.
  const auto end = static_cast<int>(dot) + exponent + kDigitsBelowSecond;
  if (end < 0) return 0;
  const auto cut = static_cast<std::size_t>(end);
  const bool round_up = cut < digits.size() && digits[cut] >= '5';
  digits.resize(cut, '0');
  const std::optional<nav::TimeNs> ns = ParseInteger<nav::TimeNs>("0" + digits);
  if (!ns) return std::nullopt;
  const nav::TimeNs rounded = *ns + (round_up ? 1 : 0);
  return negative ? -rounded : rounded;
}

}  // namespace polnav::testbed
