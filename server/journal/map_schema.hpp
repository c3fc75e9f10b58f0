/// A map file's tables: made, and known again; and what is fixed when it is made.
#pragma once

#include "server/journal/database.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::journal {

inline constexpr std::int64_t kMapApplicationId = 0x4557'6D70;  ///< "EWmp".
inline constexpr std::int64_t kMapFormat = 1;

/// Into an empty database: the tables, the format's numbers, the identity.
[[nodiscard]] protocol::Result<void> make_map_schema(Database& database, const Identity& identity);

/// That this is a map file of this format, with exactly its tables. Fails with bad_version or
/// `damaged`.
[[nodiscard]] protocol::Result<void> check_map_schema(Database& database);

[[nodiscard]] protocol::Result<Identity> read_identity(Database& database);
/// Within a transaction.
[[nodiscard]] protocol::Result<void> write_identity(Database& database, const Identity& identity);

}  // namespace earthwork::journal
