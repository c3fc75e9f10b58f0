/// Any value that can stand in a message or a record, for properties.
#pragma once

#include <rapidcheck.h>

#include "protocol/chunk_record.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {

rc::Gen<MapSettings> any_settings();
rc::Gen<Edit> any_edit();
rc::Gen<LayerChange> any_layer_change();
rc::Gen<Action> any_action();
rc::Gen<ClientMessage> any_client_message();
rc::Gen<ServerMessage> any_server_message();
/// Random indices and normals, chains among the sections; not a mesh anybody would draw.
rc::Gen<ChunkMesh> any_mesh(std::size_t max_vertices);
rc::Gen<ChunkRecord> any_record(std::size_t max_vertices);

}  // namespace earthwork::protocol
