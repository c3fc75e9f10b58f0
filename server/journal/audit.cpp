#include "server/journal/audit.hpp"

#include <optional>
#include <string>
#include <utility>

#include "server/journal/author_check.hpp"
#include "server/journal/damage.hpp"
#include "server/journal/event_pages.hpp"
#include "server/journal/execution.hpp"
#include "server/journal/findings.hpp"
#include "server/journal/keyframe_check.hpp"

namespace earthwork::journal {
namespace {

using protocol::Failure;
using protocol::Result;

/// What `read` has; nothing when it is damaged, which is then found.
template <class List>
Result<std::optional<List>> or_finding(Result<List> read, Findings& findings) {
  if (read) return std::optional(std::move(*read));
  if (auto taken = findings.take(std::move(read.error())); !taken)
    return tl::unexpected<Failure>(std::move(taken.error()));
  return std::nullopt;
}

/// Goes through the log once, and stops at what else there is to compare where it comes by.
class Walk {
 public:
  Walk(Journal& journal, std::vector<Keyframe> keyframes, std::optional<AuthorCheck> authors)
      : journal_(journal),
        keyframes_(std::move(keyframes)),
        authors_(std::move(authors)),
        executed_(journal.identity().settings) {}

  /// Fails with what is no damage.
  Result<void> run(Findings& findings) {
    auto read = read_events(journal_, 0, journal_.last_seq(),
                            [&](const history::Event& event) { return step(event, findings); });
    if (!read) {
      if (authors_) authors_->at_end(good_, findings);
      return findings.take(std::move(read.error()));
    }
    if (authors_) authors_->at_end(UINT64_MAX, findings);
    for (; next_ < keyframes_.size(); ++next_)
      findings.add("keyframes", keyframes_[next_].seq,
                   "the log has only " + std::to_string(good_) + " events");
    return {};
  }
  [[nodiscard]] Audit result(Findings& findings) const {
    return {.events = good_, .hash = hash_, .keyframes = agreed_, .findings = findings.release()};
  }

 private:
  Result<void> step(const history::Event& event, Findings& findings) {
    if (auto applied = executed_.apply(event); !applied)
      return tl::unexpected<Failure>(in_events_of(journal_, std::move(applied.error())));
    good_ = executed_.seq;
    hash_ = executed_.hash;
    if (authors_) authors_->executed(event, executed_.authors, findings);
    return look_at_keyframe(findings);
  }
  Result<void> look_at_keyframe(Findings& findings) {
    if (next_ == keyframes_.size() || keyframes_[next_].seq != executed_.seq) return {};
    auto agrees = check_keyframe(journal_, keyframes_[next_], executed_, findings);
    if (!agrees) return tl::unexpected<Failure>(std::move(agrees.error()));
    if (*agrees) ++agreed_;
    if (++next_ == keyframes_.size() && authors_)
      authors_->at_keyframe(executed_.seq, executed_.authors, findings);
    return {};
  }

  Journal& journal_;
  const std::vector<Keyframe> keyframes_;
  std::optional<AuthorCheck> authors_;  // none: they cannot be read
  Execution executed_;
  std::uint64_t good_ = 0, hash_ = 0;  // up to the last event that agreed
  std::uint64_t agreed_ = 0;
  std::size_t next_ = 0;  // of keyframes_
};

}  // namespace

Result<Audit> audit(Journal& journal) {
  Findings findings(journal.name());
  auto keyframes = or_finding(journal.keyframes(), findings);
  if (!keyframes) return tl::unexpected<Failure>(std::move(keyframes.error()));
  auto authors = or_finding(journal.authors(), findings);
  if (!authors) return tl::unexpected<Failure>(std::move(authors.error()));

  std::optional<AuthorCheck> check;
  if (*authors) check.emplace(std::move(**authors));
  Walk walk(journal, std::move(*keyframes).value_or(std::vector<Keyframe>{}), std::move(check));
  if (auto walked = walk.run(findings); !walked)
    return tl::unexpected<Failure>(std::move(walked.error()));
  return walk.result(findings);
}

}  // namespace earthwork::journal
