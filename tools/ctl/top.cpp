#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <string>

#include "ipc/runtime.hpp"
#include "tools/ctl/bus_watch.hpp"
#include "tools/ctl/commands.hpp"
#include "tools/ctl/render.hpp"

namespace gvom::ctl {

namespace {

constexpr std::chrono::milliseconds kStep{50};
constexpr std::chrono::seconds kFramePeriod{1};

/// The screen while top runs, if stdout is one; as it was afterwards.
class Screen {
 public:
  Screen() : is_terminal_(::isatty(STDOUT_FILENO) == 1), has_keys_(::isatty(STDIN_FILENO) == 1) {
    if (is_terminal_) std::fputs("\033[?1049h\033[?25l", stdout);  // another page, no cursor
    if (!has_keys_) return;
    ::tcgetattr(STDIN_FILENO, &before_);
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    ::tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  }
  ~Screen() {
    if (is_terminal_) std::fputs("\033[?25h\033[?1049l", stdout);
    std::fflush(stdout);
    if (has_keys_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  void show(const std::string& text) const {
    if (!is_terminal_) {
      std::printf("%s\n", text.c_str());
    } else {
      std::string in_place = "\033[H";
      for (const char c : text) in_place += c == '\n' ? std::string("\033[K\n") : std::string(1, c);
      std::fputs((in_place + "\033[J").c_str(), stdout);
    }
    std::fflush(stdout);
  }

  [[nodiscard]] bool wants_to_quit() const {
    pollfd key{STDIN_FILENO, POLLIN, 0};
    char pressed = 0;
    return has_keys_ && ::poll(&key, 1, 0) > 0 && ::read(STDIN_FILENO, &pressed, 1) == 1 &&
           (pressed == 'q' || pressed == 'Q');
  }

 private:
  bool is_terminal_;
  bool has_keys_;
  termios before_{};
};

}  // namespace

int show_top(const Watched& watched, std::uint64_t count) {
  BusWatch watch;
  const Screen screen;
  auto next_frame = std::chrono::steady_clock::now() + kFramePeriod;
  for (std::uint64_t shown = 0; count == 0 || shown < count;) {
    if (watched.lifecycle.stopping() || screen.wants_to_quit()) break;
    watch.step(kStep);
    if (std::chrono::steady_clock::now() < next_frame) continue;
    next_frame += kFramePeriod;
    screen.show(to_table(assess(watch.broker(), watch.observed(), watched.expected, watched.surroundings,
                                ipc::Moment::now())));
    ++shown;
  }
  return to_int(services::ExitCode::ok);
}

}  // namespace gvom::ctl
