#include "tools/endurance/faults.hpp"

#include <signal.h>

#include <utility>

namespace gvom::endurance {

namespace {

constexpr std::int64_t kLasts_ns = 2'000'000'000;
constexpr double kPatience_s = 60;  // then it is not waited for any more

}  // namespace

Faults::Faults(std::uint32_t seed, double every_s, double recovery_s, const std::vector<std::string>& lidars,
               Board& board, Hands hands)
    : random_(seed),
      every_s_(every_s),
      recovery_s_(recovery_s),
      lidars_(lidars),
      board_(board),
      hands_(std::move(hands)) {}

void Faults::step(std::int64_t now_ns, double run_s, bool may_begin) {
  if (current_) return watch(*current_, now_ns);
  if (!may_begin) return;
  if (next_ns_ == 0) {  // half to one and a half of the mean
    const double factor = 0.5 + static_cast<double>(random_() % 1000) / 1000;
    next_ns_ = now_ns + static_cast<std::int64_t>(every_s_ * factor * 1e9);
  }
  if (now_ns < next_ns_) return;
  Fault fault = draw();
  fault.at_s = run_s;
  fault.begin_ns = fault.cure_ns = now_ns;
  if (!begin(fault)) return;
  next_ns_ = 0;
  current_ = std::move(fault);
}

/// One in nine is the broker's death; half of the others are deaths, too.
Faults::Fault Faults::draw() {
  Fault fault{};
  fault.lidar = random_() % lidars_.size();
  const std::string ingest = "gvom-ingest-" + lidars_[fault.lidar];
  const std::string processes[] = {ingest, "gvom-fusion", "gvom-odometry"};
  switch (random_() % 9) {
    case 0:
      fault.kind = Kind::kill;
      fault.target = "gvom-roudi";
      break;
    case 1:
    case 2:
    case 3:
    case 4:
      fault.kind = Kind::kill;
      fault.target = processes[random_() % 3];
      break;
    case 5:
      fault.kind = Kind::stop;
      fault.target = processes[random_() % 3];
      break;
    case 6:
      fault.kind = Kind::silence;
      break;
    case 7:
      fault.kind = Kind::loss;
      break;
    default:
      fault.kind = Kind::garbage;
      break;
  }
  if (fault.target.empty()) fault.target = lidars_[fault.lidar];
  return fault;
}

bool Faults::begin(Fault& fault) {
  const bool lasts = fault.kind != Kind::kill;
  fault.cured = !lasts;
  if (lasts) fault.cure_ns = fault.begin_ns + kLasts_ns;
  switch (fault.kind) {
    case Kind::kill:
      return hands_.send(fault.target, SIGKILL);
    case Kind::stop:
      return hands_.send(fault.target, SIGSTOP);
    case Kind::silence:
      set_mode(fault, SendMode::silent);
      return true;
    case Kind::loss:
      set_mode(fault, SendMode::loss);
      return true;
    case Kind::garbage:
      set_mode(fault, SendMode::garbage);
      return true;
  }
  return false;
}

void Faults::cure(Fault& fault) {
  fault.cured = true;
  if (fault.kind == Kind::stop)
    hands_.send(fault.target, SIGCONT);
  else
    set_mode(fault, SendMode::well);
}

void Faults::watch(Fault& fault, std::int64_t now_ns) {
  if (!fault.cured && now_ns >= fault.cure_ns) {
    cure(fault);
    fault.cure_ns = now_ns;
  }
  hands_.disturb(fault.begin_ns, now_ns, "a fault made");
  if (!fault.cured) return;
  const double since_s = static_cast<double>(now_ns - fault.cure_ns) * 1e-9;
  const bool well = hands_.all_is_well(fault.cure_ns);
  if (!well && since_s < kPatience_s) return;
  results_.push_back({text_of(fault), fault.at_s, since_s, well && since_s <= recovery_s_});
  current_.reset();
}

void Faults::set_mode(const Fault& fault, SendMode mode) {
  board_.modes[fault.lidar] = mode;
}

std::string Faults::text_of(const Fault& fault) {
  switch (fault.kind) {
    case Kind::kill:
      return "kill -9 of " + fault.target;
    case Kind::stop:
      return fault.target + " stopped for 2 s";
    case Kind::silence:
      return "lidar " + fault.target + " silent for 2 s";
    case Kind::loss:
      return "30 % of the packets of " + fault.target + " lost for 2 s";
    case Kind::garbage:
      return "garbage on the port of " + fault.target + " for 2 s";
  }
  return "";
}

}  // namespace gvom::endurance
