#include "server/mesh/triangulate.hpp"

#include <cassert>

namespace earthwork::mesh {

void Triangulator::run(std::span<const Point> points, std::span<const std::uint16_t> next,
                       std::vector<std::uint16_t>& triangles) {
  assert(points.size() == next.size() && points.size() < kNone);
  points_ = points, next_ = next, triangles_ = &triangles;
  previous_.assign(points.size(), kNone);
  for (std::size_t v = 0; v < next.size(); ++v) {
    if (next[v] != kNone) previous_[next[v]] = static_cast<std::uint16_t>(v);
  }
  left_of_.resize(points.size()), right_of_.resize(points.size());
  nodes_.clear(), intervals_.clear();
  first_ = hint_ = kNil;
  for (std::size_t v = 0; v < next.size(); ++v) {
    if (next[v] != kNone) visit(static_cast<std::uint16_t>(v));
  }
  assert(first_ == kNil);
}

// Points are numbered in sweep order, so comparing numbers tells what is above and below.
void Triangulator::visit(std::uint16_t v) {
  const std::uint16_t from = previous_[v], to = next_[v];
  if (from > v && to > v) {
    bool inside = false;
    const Index at = locate(v, inside);
    if (inside) {
      split(v, at);
    } else {
      hint_ = new_interval(at);
      start(v);
    }
  } else if (from < v && to < v) {
    const Index left = right_of_[from], right = left_of_[to];
    if (left == right) {
      close(v, left);
    } else {
      merge(v, left, right);
    }
  } else if (from < v) {
    hint_ = right_of_[from];
    push_right(intervals_[hint_], v);
    right_of_[v] = hint_;
  } else {
    hint_ = left_of_[to];
    push_left(intervals_[hint_], v);
    left_of_[v] = hint_;
  }
}

void Triangulator::start(std::uint16_t v) {
  Interval& interval = intervals_[hint_];
  interval.head = interval.tail = interval.peak = new_node(v);
  left_of_[v] = right_of_[v] = hint_;
}

// A hole begins, or a notch ends: the ground parts at v. v is joined to the chain's highest vertex,
// which nothing hides from it, and each side goes on from there.
void Triangulator::split(std::uint16_t v, Index left) {
  const Index right = new_interval(left);
  Interval &l = intervals_[left], &r = intervals_[right];
  const Index peak = l.peak, copy = new_node(nodes_[peak].vertex);
  r.head = r.peak = copy;
  r.tail = l.tail == peak ? copy : l.tail;
  nodes_[copy].after = nodes_[peak].after;
  if (nodes_[copy].after != kNil) nodes_[nodes_[copy].after].before = copy;
  nodes_[peak].after = kNil;
  l.tail = peak;
  right_of_[nodes_[r.tail].vertex] = right;
  push_right(l, v);
  push_left(r, v);
  right_of_[v] = left, left_of_[v] = right;
  hint_ = right;
}

// Two grounds meet at v and are one from here on.
void Triangulator::merge(std::uint16_t v, Index left, Index right) {
  Interval &l = intervals_[left], &r = intervals_[right];
  push_right(l, v);
  push_left(r, v);
  const Index joint = l.tail, rest = nodes_[r.head].after;
  nodes_[joint].after = rest;
  if (rest != kNil) {
    nodes_[rest].before = joint;
    l.tail = r.tail;
  }
  l.peak = joint;
  right_of_[nodes_[l.tail].vertex] = left;
  remove_interval(right);
  hint_ = left;
}

void Triangulator::close(std::uint16_t v, Index interval) {
  Index node = intervals_[interval].head;
  for (Index after = nodes_[node].after; after != kNil; after = nodes_[node].after) {
    emit(nodes_[node].vertex, nodes_[after].vertex, v);
    node = after;
  }
  hint_ = intervals_[interval].before;
  remove_interval(interval);
  if (hint_ == kNil) hint_ = first_;
}

void Triangulator::push_right(Interval& interval, std::uint16_t v) {
  Index tail = interval.tail;
  for (Index before = nodes_[tail].before; before != kNil; before = nodes_[tail].before) {
    const std::uint16_t a = nodes_[before].vertex, b = nodes_[tail].vertex;
    if (turn(a, b, v) <= 0) break;
    emit(a, b, v);
    tail = before;
  }
  const Index node = new_node(v);
  nodes_[node].before = tail;
  nodes_[tail].after = node;
  interval.tail = interval.peak = node;
}

void Triangulator::push_left(Interval& interval, std::uint16_t v) {
  Index head = interval.head;
  for (Index after = nodes_[head].after; after != kNil; after = nodes_[head].after) {
    const std::uint16_t a = nodes_[head].vertex, b = nodes_[after].vertex;
    if (turn(v, a, b) <= 0) break;
    emit(v, a, b);
    head = after;
  }
  const Index node = new_node(v);
  nodes_[node].after = head;
  nodes_[head].before = node;
  interval.head = interval.peak = node;
}

// The interval that v lies inside, or the one to its left (kNil: there is none). Vertices
// come left to right along a row, so the last place is a good guess for the next.
Triangulator::Index Triangulator::locate(std::uint16_t v, bool& inside) {
  inside = false;
  Index at = hint_ == kNil ? first_ : hint_;
  if (at == kNil) return kNil;
  const auto right_of_left_edge = [&](Index k) {
    const std::uint16_t lower = nodes_[intervals_[k].head].vertex;
    return turn(lower, previous_[lower], v) < 0;
  };
  const auto left_of_right_edge = [&](Index k) {
    const std::uint16_t lower = nodes_[intervals_[k].tail].vertex;
    return turn(lower, next_[lower], v) > 0;
  };
  while (at != kNil && !right_of_left_edge(at)) at = intervals_[at].before;
  if (at == kNil) return kNil;
  for (Index after = intervals_[at].after; after != kNil && right_of_left_edge(after);
       after = intervals_[at].after) {
    at = after;
  }
  inside = left_of_right_edge(at);
  return at;
}

Triangulator::Index Triangulator::new_interval(Index before) {
  const auto made = static_cast<Index>(intervals_.size());
  const Index after = before == kNil ? first_ : intervals_[before].after;
  intervals_.push_back({kNil, kNil, kNil, before, after});
  (before == kNil ? first_ : intervals_[before].after) = made;
  if (after != kNil) intervals_[after].before = made;
  return made;
}

void Triangulator::remove_interval(Index interval) {
  const auto [head, tail, peak, before, after] = intervals_[interval];
  (before == kNil ? first_ : intervals_[before].after) = after;
  if (after != kNil) intervals_[after].before = before;
}

Triangulator::Index Triangulator::new_node(std::uint16_t v) {
  nodes_.push_back({v, kNil, kNil});
  return static_cast<Index>(nodes_.size() - 1);
}

std::int64_t Triangulator::turn(std::uint16_t a, std::uint16_t b, std::uint16_t c) const {
  const Point p = points_[a], q = points_[b], r = points_[c];
  const std::int64_t ux = q.x - p.x, uy = q.y - p.y, vx = r.x - q.x, vy = r.y - q.y;
  return ux * vy - uy * vx;
}

void Triangulator::emit(std::uint16_t a, std::uint16_t b, std::uint16_t c) {
  assert(turn(a, b, c) > 0);
  triangles_->push_back(a), triangles_->push_back(b), triangles_->push_back(c);
}

}  // namespace earthwork::mesh
