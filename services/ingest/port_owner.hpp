// Whose a live port is: the sender with a sensor's rate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "services/ingest/address.hpp"

namespace gvom::ingest {

/// Who sends: an address, and what the packet says of its sensor.
struct Sender {
  Address address{};
  std::uint64_t id = 0;
  friend bool operator==(const Sender& a, const Sender& b) { return a.address == b.address && a.id == b.id; }
};

/// A sender is proven once it has sent as many packets within a quarter of a second, or since its trial
/// began, as a sensor does (between a quarter of its least and three times its most). The first sender is on
/// trial for a second; what comes of its packets counts once it is proven. A proven one loses the port to
/// another proven one when it has not had a sensor's rate for a second; an unproven one at once.
class PortOwner {
 public:
  PortOwner(double least_packets_per_s, double most_packets_per_s);

  enum class Verdict {
    use,        ///< The packet is the owner's.
    slow,       ///< The owner's, which has been on trial for too long.
    other,      ///< Another's.
    new_owner,  ///< Another's, who owns the port from the next packet on.
  };
  Verdict judge(const Sender& sender, std::int64_t received_ns);

  [[nodiscard]] bool is_known() const { return owner_.has_value(); }
  [[nodiscard]] bool is_proven() const { return owner_ && rates_[*owner_].proven_ns != 0; }

 private:
  struct Rate {
    Sender sender;
    std::int64_t window_ns = 0;  // its beginning
    int packets = 0;             // in the window
    int before = 0;              // in the window before
    std::int64_t heard_ns = 0;   // 0: nobody is here
    std::int64_t proven_ns = 0;  // when last; 0: never
  };

  std::size_t rate_of(const Sender& sender);
  void count(Rate& rate, std::int64_t now_ns) const;
  void judge_trial(Rate& rate, std::int64_t now_ns);
  [[nodiscard]] bool is_vacant(const Rate& challenger, std::int64_t now_ns) const;

  int least_;  // packets in a window
  int most_;
  std::array<Rate, 8> rates_{};
  std::optional<std::size_t> owner_;
  std::int64_t trial_ns_ = 0;  // since when the owner is on trial
  int trial_packets_ = 0;
};

}  // namespace gvom::ingest
