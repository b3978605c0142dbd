#include "output/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

namespace app {

std::string sha256OfFile(const std::filesystem::path& file) {
  std::error_code failed;
  if (std::filesystem::exists(file, failed) && !std::filesystem::is_directory(file, failed) &&
      !std::filesystem::is_regular_file(file, failed)) {  // opening one may take for ever
    throw std::runtime_error(
        fmt::format("{}: is a pipe or a device, must be a file", file.string()));
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    throw std::runtime_error(fmt::format("{}: cannot be read", file.string()));
  }
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> digest(EVP_MD_CTX_new(),
                                                                       &EVP_MD_CTX_free);
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int size = 0;
  bool ok = digest && EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) == 1;
  std::vector<char> block(1 << 16);
  while (ok && stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    ok = EVP_DigestUpdate(digest.get(), block.data(), static_cast<std::size_t>(stream.gcount())) ==
         1;
  }
  ok = ok && !stream.bad() && EVP_DigestFinal_ex(digest.get(), bytes.data(), &size) == 1;
  if (!ok) throw std::runtime_error(fmt::format("{}: SHA-256 failed", file.string()));
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", bytes[i]);
  return hex;
}

}  // namespace app
