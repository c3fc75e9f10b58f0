/// Numbers that nobody can guess: epochs, session names, keys.
#pragma once

#include <cstdint>
#include <string>

namespace earthwork::room {

/// From the operating system's generator. Throws std::system_error when it fails. Any thread.
[[nodiscard]] std::uint64_t random_u64();
/// 128 random bits as 32 hex digits, lower case.
[[nodiscard]] std::string random_key();

}  // namespace earthwork::room
