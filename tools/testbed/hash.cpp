#include "tools/testbed/hash.h"

#include <openssl/evp.h>

#include <array>
#include <stdexcept>

namespace polnav::testbed {
namespace {

void Check(int success) {
  if (success != 1) throw std::logic_error("OpenSSL's SHA-256 failed");
}

}  // namespace

void Sha256::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  if (!context_) throw std::logic_error("OpenSSL's SHA-256 failed");
  Check(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

void Sha256::Update(const void* data, std::size_t size_bytes) {
  Check(EVP_DigestUpdate(context_.get(), data, size_bytes));
}

std::string Sha256::HexDigest() const {
  const std::unique_ptr<evp_md_ctx_st, Free> copy(EVP_MD_CTX_new());
  if (!copy) throw std::logic_error("OpenSSL's SHA-256 failed");
  Check(EVP_MD_CTX_copy_ex(copy.get(), context_.get()));
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  Check(EVP_DigestFinal_ex(copy.get(), digest.data(), &size));
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 15U];
  }
  return text;
}

std::string Sha256Of(std::string_view text) {
  Sha256 hash;
  hash.Update(text);
  return hash.HexDigest();
}

}  // namespace polnav::testbed
