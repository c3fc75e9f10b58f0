// How long to wait before the next attempt to connect: at random, so that the clients of a server
// that was started again do not all come at once, and longer each time.
const SHORTEST_MS = 250;
const LONGEST_MS = 30_000;

// Before attempt 0, 1, 2 ... `random` is from 0 to 1.
export function waitBefore(attempt, random = Math.random()) {
  const longest = Math.min(LONGEST_MS, SHORTEST_MS * 2 ** (attempt + 1));
  return SHORTEST_MS + random * (longest - SHORTEST_MS);
}
