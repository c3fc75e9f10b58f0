// A transcript: what clients say to a server, and what it is to answer, a line each.
//
//     # A comment.
//     map demo {"chunk_resolution":8}      a map is made, over HTTP
//     A> {"type":"ping","id":1}            client A sends this text
//     A>hex 00ff                           client A sends these bytes, as a binary message
//     A< {"type":"done","id":1}            client A receives this
//     A>close                              client A closes
//     A< closed
//     stop                                 the server is asked to end
//     show meshes                          from here on, records are written out whole
//     show limits                          from here on, the limits in a welcome are too
//     show presence                        from here on, who is there and points where
//
// A client is an upper-case letter and connects when it first says something. What a client
// receives is normalised: a session, a key, an author or an epoch becomes $session1, $key1,
// $author1, $epoch1, numbered as they appear, and can be sent by these names; a time is $time.
// Presence comes on a timer, so a transcript that does not show it has none. Messages that follow
// each other without an answer between them are sent in one breath; when a transcript is rewritten,
// `A< ?` keeps them apart. In what is sent, $spaces(N) stands for N spaces, $path(N) for an array
// of N points, and $nest(N) for N arrays one in the other.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace earthwork::transcripts {

struct Line {
  enum class Kind { note, map, send, send_hex, close, receive, stop, show } kind = Kind::note;
  char client = 0;   // of send, send_hex, close and receive
  std::string text;  // what follows
};

struct Transcript {
  std::vector<Line> lines;
};

/// Throws std::runtime_error naming the line for one that cannot be read.
Transcript parse(std::string_view text);
std::string write(const Transcript& transcript);

/// What is sent in place of a line's text: macros replaced, names not.
std::string expand(std::string text);

}  // namespace earthwork::transcripts
