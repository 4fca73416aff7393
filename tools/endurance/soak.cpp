#include "tools/endurance/soak.hpp"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "ipc/broker_probe.hpp"
#include "tools/endurance/feeder.hpp"

namespace gvom::endurance {

namespace {

using services::ExitCode;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr int kLongestWait_ms = 50;
constexpr std::int64_t kUp_ns = 60 * kSecond_ns;
constexpr std::int64_t kLastRound_ns = 60 * kSecond_ns;  // it, and the fault under way, may take so long
constexpr std::int64_t kLastLooks_ns = 3'500'000'000;    // at everybody's Health, more than twice
constexpr std::int64_t kFlowing_ns = kSecond_ns;
constexpr std::int64_t kSteady_ns = 1'200'000'000;  // the window is full again

std::vector<std::string> processes_of(const std::vector<std::string>& lidars) {
  std::vector<std::string> names{"gvom-fusion", "gvom-odometry"};
  for (const std::string& lidar : lidars) names.push_back(tools::kIngestPrefix + lidar);
  return names;
}

double warm_up_s(double run_s, const Recording& recording) {
  const double two_rounds_s = 2e-9 * static_cast<double>(recording.packets.back().due_ns);
  return std::max(std::min(60.0, 0.2 * run_s), two_rounds_s);
}

}  // namespace

Soak::Soak(const SoakOptions& options, const Recording& recording, Board& board, Supervisor* supervisor,
           services::Lifecycle& lifecycle)
    : options_(options),
      board_(board),
      lifecycle_(lifecycle),
      supervisor_(supervisor),
      feeder_([&](int socket) { return feed_packets(recording, options.ports, board, socket); }),
      listener_(board),
      rounds_(recording.sweeps),
      pauses_(options.lidars, ledger_),
      health_(processes_of(options.lidars)),
      sampler_(options.out, warm_up_s(options.minutes * 60, recording)),
      faults_(options.seed, options.fault_every_s, options.recovery_s, options.lidars, board, hands()) {
  if (supervisor != nullptr) watchdog_.emplace(*supervisor);
}

ExitCode Soak::run() {
  if (!sampler_.files_are_good()) {
    std::fprintf(stderr, "gvom-soak: %s: its files cannot be written\n", options_.out.c_str());
    return ExitCode::unavailable;
  }
  if (!wait_until_up()) return ExitCode::unavailable;
  feed();
  finish();
  listener_.ended(ipc::monotonic_ns());  // before the broker goes
  return ExitCode::ok;
}

void Soak::step() {
  const std::int64_t now_ns = ipc::monotonic_ns();
  if (!round_is_open_ || faults_.is_under_way()) unsteady_ns_ = now_ns;
  if (watchdog_) watchdog_->step(now_ns, health_, listener_.on_bus_ns(now_ns));
  listener_.step(now_ns);
  receive();
  if (supervisor_ != nullptr && supervisor_->failure()) run_.broken_off = *supervisor_->failure();
  if (!feeding_) return;
  health_.look_for_silence(now_ns, rounds_);
  rounds_.settle(now_ns);
  sampler_.sample(now_ns, processes(), health_, rounds_);
  sampler_.say_progress(now_ns);
}

bool Soak::wait_until_up() {
  const std::int64_t deadline_ns = ipc::monotonic_ns() + kUp_ns;
  while (!health_.all_heard()) {
    if (lifecycle_.stopping() || !run_.broken_off.empty() || ipc::monotonic_ns() > deadline_ns) {
      std::fprintf(stderr, "gvom-soak: the graph did not come up%s%s\n", run_.broken_off.empty() ? "" : ": ",
                   run_.broken_off.c_str());
      return false;
    }
    step();
  }
  for (const std::string& process : health_.expected())
    pauses_.note_first(process, health_.newest(process)->pid);
  return true;
}

void Soak::feed() {
  const std::int64_t begin_ns = ipc::monotonic_ns();
  const auto end_ns = begin_ns + static_cast<std::int64_t>(options_.minutes * 60e9);
  feeding_ = true;
  sampler_.begin(begin_ns);
  board_.hold = false;
  while (ipc::monotonic_ns() < end_ns && !lifecycle_.stopping() && run_.broken_off.empty()) {
    step();
    if (!options_.faults) continue;
    const std::int64_t now_ns = ipc::monotonic_ns();
    const bool well = rounds_.rounds() > 0;  // once it has run
    faults_.step(now_ns, sampler_.run_s(now_ns), well && now_ns < end_ns - 10 * kSecond_ns);
    for (; faults_told_ < faults_.results().size(); ++faults_told_) {
      const FaultResult& fault = faults_.results()[faults_told_];
      std::printf("%6.0f s: %s: well again after %.1f s\n", fault.at_s, fault.what.c_str(),
                  fault.recovered_s);
      sampler_.add_fault(fault.at_s, fault.recovered_s, fault.what);
    }
  }
  if (lifecycle_.stopping()) run_.broken_off = "interrupted";
}

/// The round under way goes to its end; then everybody tells twice what was counted, and all must agree.
void Soak::finish() {
  board_.hold = true;
  const std::int64_t deadline_ns = ipc::monotonic_ns() + kLastRound_ns;
  while ((round_is_open_ || faults_.is_under_way()) && ipc::monotonic_ns() < deadline_ns &&
         run_.broken_off.empty()) {
    step();
    const std::int64_t now_ns = ipc::monotonic_ns();
    if (options_.faults) faults_.step(now_ns, sampler_.run_s(now_ns), false);
  }
  run_.lasted_s = sampler_.run_s(ipc::monotonic_ns());
  feeding_ = false;  // from now on everybody complains that nothing comes
  const std::int64_t looked_ns = ipc::monotonic_ns() + kLastLooks_ns;
  while (ipc::monotonic_ns() < looked_ns && run_.broken_off.empty()) step();
  pauses_.end(ipc::monotonic_ns());
  rounds_.settle(ipc::monotonic_ns() + 10 * kSecond_ns);
}

void Soak::receive() {
  pollfd readable[2] = {{feeder_.socket(), POLLIN, 0}, {listener_.socket(), POLLIN, 0}};
  ::poll(readable, 2, kLongestWait_ms);
  if (!drain(feeder_.socket())) run_.broken_off = "the process that sends the packets ended";
  if (listener_.socket() >= 0 && !drain(listener_.socket())) listener_.ended(ipc::monotonic_ns());
}

/// False if the other end is gone.
bool Soak::drain(int socket) {
  Note note;
  Received received = Received::nothing;
  while ((received = receive_note(socket, note)) == Received::note) take(note);
  return received != Received::end;
}

void Soak::take(const Note& note) {
  const std::int64_t now_ns = ipc::monotonic_ns();
  switch (note.kind) {
    case NoteKind::alive:
      run_.voxel_maps_heard = std::max(run_.voxel_maps_heard, note.as<AliveNote>().voxel_maps);
      break;
    case NoteKind::layers:
      take_layers(note.as<LayersNote>());
      break;
    case NoteKind::health:
      if (feeding_ || !health_.all_heard()) health_.take(note.as<ipc::Health>(), rounds_);
      pauses_.take(note.as<ipc::Health>());
      break;
    case NoteKind::pools:
      sampler_.take(note.list_of<ipc::PoolUse>(), now_ns, now_ns - unsteady_ns_ > kSteady_ns);
      break;
    case NoteKind::round_begin:
      return take_round(note.as<RoundNote>(), true);
    case NoteKind::round_end:
      return take_round(note.as<RoundNote>(), false);
  }
  listener_.heard(now_ns);
}

void Soak::take_layers(const LayersNote& note) {
  run_.layers_missed += note.lost - std::min(note.lost, newest_layers_.lost);
  newest_layers_ = note;
  rounds_.add(note);
  pauses_.take(note);
  if (feeding_) sampler_.take(note);
}

void Soak::take_round(const RoundNote& note, bool begins) {
  round_is_open_ = begins;
  unsteady_ns_ = note.mono_ns;
  run_.packets_sent = 0;
  for (const std::uint64_t sent : note.sent) run_.packets_sent += sent;
  if (begins) {
    pauses_.end(note.mono_ns);
    rounds_.begin(note.epoch);
  } else if (note.whole != 0) {
    rounds_.end(note.epoch, note.mono_ns);
    pauses_.begin(note);
  }
}

std::vector<std::pair<std::string, pid_t>> Soak::processes() const {
  std::vector<std::pair<std::string, pid_t>> all;
  for (const std::string& process : health_.expected())
    if (const ipc::Health* const newest = health_.newest(process))
      all.emplace_back(process, static_cast<pid_t>(newest->pid));
  if (const auto broker = ipc::broker_pid()) all.emplace_back("gvom-roudi", *broker);
  if (listener_.pid() > 0) all.emplace_back("soak-planner", listener_.pid());
  all.emplace_back("soak", ::getpid());
  return all;
}

Faults::Hands Soak::hands() {
  const auto send = [this](const std::string& process, int signal) {
    for (const auto& [name, pid] : processes())
      if (name == process) return ::kill(pid, signal) == 0;
    return false;
  };
  const auto well = [this](std::int64_t since_ns) { return all_is_well(since_ns); };
  const auto disturb = [this](std::int64_t from_ns, std::int64_t to_ns, const std::string& what) {
    rounds_.disturb(from_ns, to_ns, what);
  };
  return {send, well, disturb};
}

bool Soak::all_is_well(std::int64_t since_ns) const {
  const std::int64_t now_ns = ipc::monotonic_ns();
  const LayersNote& layers = newest_layers_;
  return health_.all_ok(since_ns) && layers.published_mono_ns > since_ns && layers.missing == 0 &&
         now_ns - layers.heard_mono_ns < kFlowing_ns;
}

bool Soak::write_verdict() {
  run_.how = supervisor_ != nullptr ? "processes" : "systemd";
  run_.planned_s = options_.minutes * 60;
  run_.lidars = options_.lidars;
  run_.faults_made = options_.faults;
  run_.seed = options_.seed;
  run_.layers_heard = sampler_.layers();
  run_.latency_p50_ms = sampler_.latency().percentile_ms(0.5);
  run_.latency_p99_ms = sampler_.latency().percentile_ms(0.99);
  run_.latency_max_ms = sampler_.latency().max_ms();
  run_.rounds = &rounds_;
  run_.ledger = &ledger_;
  run_.health = &health_;
  run_.record = &sampler_.record();
  run_.faults = faults_.results();
  const std::string path = options_.out + "/verdict.json";
  std::ofstream file(path);
  file << json_of(run_);
  file.close();
  if (!file) std::fprintf(stderr, "gvom-soak: %s cannot be written\n", path.c_str());
  const auto failures = failures_of(run_);
  for (const std::string& failure : failures) std::printf("FAILED: %s\n", failure.c_str());
  return file && failures.empty();
}

}  // namespace gvom::endurance
