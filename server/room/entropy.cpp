#include "server/room/entropy.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "protocol/chunk_record.hpp"

namespace earthwork::room {

std::uint64_t random_u64() {
  std::uint64_t value = 0;
  if (getentropy(&value, sizeof value) != 0)
    throw std::system_error(errno, std::generic_category(), "getentropy");
  return value;
}

std::string random_key() { return protocol::hex(random_u64()) + protocol::hex(random_u64()); }

}  // namespace earthwork::room
