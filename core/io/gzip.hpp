#pragma once

#include <string>
#include <string_view>

namespace barchan {

/// Does it begin as gzip data do? Text never does.
[[nodiscard]] bool is_gzip(std::string_view bytes);

/// What was packed by gzip (RFC 1952), one member after another.
/// @throws InputError naming `file`: damaged or cut off, or more than fits in memory
[[nodiscard]] std::string unzipped(std::string_view bytes, const std::string& file);

/// A regular file, unpacked where it is gzip data, whatever its name. @throws InputError
[[nodiscard]] std::string read_unpacked_file(const std::string& path);

}  // namespace barchan
