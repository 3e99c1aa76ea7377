// Are two streams the same, byte for byte? SHA-256 [FIPS 180-4] through OpenSSL, fed piece by
// piece.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

struct evp_md_ctx_st;

namespace polnav::testbed {

class Sha256 {
 public:
  Sha256();

  void Update(const void* data, std::size_t size_bytes);
  void Update(std::string_view text) { Update(text.data(), text.size()); }

  // The bytes of a number or flag as they lie in memory (little endian on every machine we have).
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void UpdateValue(const T& value) { Update(&value, sizeof(value)); }

  // Of everything so far, 64 lower-case hexadecimal digits; more may follow.
  [[nodiscard]] std::string HexDigest() const;

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

[[nodiscard]] std::string Sha256Of(std::string_view text);

}  // namespace polnav::testbed
