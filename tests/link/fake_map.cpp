#include "tests/link/fake_map.hpp"

namespace earthwork::link {
namespace {

/// Of an edit, or a change of layers.
std::optional<protocol::MessageId> edit_id(const std::string& text) {
  const auto message = protocol::parse_client_message(text);
  if (!message) return std::nullopt;
  if (const auto* edit = std::get_if<protocol::EditMessage>(&*message)) return edit->id;
  if (const auto* layer = std::get_if<protocol::LayerMessage>(&*message)) return layer->id;
  return std::nullopt;
}

}  // namespace

void FakeMap::play(Peer& peer) {
  heard.emplace_back();
  if (greet(peer)) {
    const bool breaks_off = heard.size() <= breaks.size();
    for (int messages = 1;; ++messages) {
      const bool last = breaks_off && messages > breaks[heard.size() - 1].after_messages;
      const std::string text = peer.read();
      heard.back().push_back(text);
      if (text.starts_with("closed")) break;
      const auto how = last ? breaks[heard.size() - 1].how : Break::How::after_the_answer;
      if (how == Break::How::with_bye)
        peer.write(protocol::write(protocol::Bye{
            .failure = {.code = protocol::Code::shutting_down, .detail = "ends", .field = {}},
            .retry_after_ms = retry_after_ms}));
      else
        take(text, how == Break::How::after_the_answer ? &peer : nullptr);
      if (last) break;
    }
  }
  if (after) after(*this, heard.size());
}

bool FakeMap::greet(Peer& peer) {
  heard.back().push_back(peer.read());
  const auto hello = protocol::parse_client_message(heard.back().back());
  if (!hello) return false;
  protocol::Welcome welcome;
  welcome.session = "0123456789abcdef";
  welcome.key = std::get<protocol::Hello>(*hello).key.value_or("0123456789abcdef0123456789abcdef");
  peer.write(protocol::write(welcome));
  heard.back().push_back(peer.read());
  if (heard.back().back().starts_with("closed")) return false;
  if (gone) {
    peer.write(R"({"type":"rejected","code":"unknown_map","message":"there is no demo"})");
    peer.read();
    return false;
  }
  protocol::Joined joined;
  joined.map = "demo";
  joined.epoch = epoch;
  joined.seq = seq;
  peer.write(protocol::write(joined));
  return true;
}

void FakeMap::take(const std::string& text, Peer* asker) {
  const auto id = edit_id(text);
  if (!id) return;
  const bool known = applied.contains(*id);
  const bool late = !known && !applied.empty() && *id < applied.rbegin()->first;
  if (!known && !late) applied.emplace(*id, ++seq);
  if (!asker) return;
  protocol::ServerMessage reply = protocol::Rejected{
      .id = *id,
      .failure = {.code = protocol::Code::id_out_of_order, .detail = "late", .field = "id"}};
  if (!late) reply = protocol::Applied{.id = *id, .seq = applied.at(*id)};
  for (int times = answers_twice ? 2 : 1; times > 0; --times) asker->write(protocol::write(reply));
}

}  // namespace earthwork::link
