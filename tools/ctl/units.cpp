#include "tools/ctl/units.hpp"

#include <systemd/sd-bus.h>
#include <systemd/sd-daemon.h>

#include <cerrno>
#include <cstdlib>

#include "tools/common/health_view.hpp"

namespace gvom::ctl {

namespace {

constexpr std::uint64_t kTimeout_us = 250'000;
constexpr char kSystemd[] = "org.freedesktop.systemd1";

sd_bus* open_private() {
  sd_bus* bus = nullptr;
  if (sd_bus_new(&bus) < 0) return nullptr;
  if (sd_bus_set_address(bus, "unix:path=/run/systemd/private") >= 0 && sd_bus_start(bus) >= 0) return bus;
  sd_bus_unref(bus);
  return nullptr;
}

sd_bus* open_bus() {
  sd_bus* bus = nullptr;
  if (sd_booted() <= 0) return nullptr;
  if (sd_bus_open_system(&bus) < 0) bus = open_private();
  if (bus != nullptr) sd_bus_set_method_call_timeout(bus, kTimeout_us);
  return bus;
}

struct Text {
  char* text = nullptr;
  ~Text() { std::free(text); }
};

}  // namespace

std::string unit_of(const std::string& process) {
  const std::string lidar = tools::lidar_of(process);
  return lidar.empty() ? process + ".service" : "gvom-ingest@" + lidar + ".service";
}

void Units::Close::operator()(sd_bus* bus) const {
  sd_bus_close_unref(bus);
}

Units::Units() : bus_(open_bus()) {}

std::optional<std::uint64_t> Units::restarts(const std::string& process) {
  if (!bus_) return std::nullopt;
  Text path;
  if (sd_bus_path_encode("/org/freedesktop/systemd1/unit", unit_of(process).c_str(), &path.text) < 0)
    return std::nullopt;
  Text loaded;
  int result = sd_bus_get_property_string(bus_.get(), kSystemd, path.text, "org.freedesktop.systemd1.Unit",
                                          "LoadState", nullptr, &loaded.text);
  std::uint32_t count = 0;
  if (result >= 0 && std::string(loaded.text) != "loaded") return std::nullopt;
  if (result >= 0)
    result = sd_bus_get_property_trivial(bus_.get(), kSystemd, path.text, "org.freedesktop.systemd1.Service",
                                         "NRestarts", nullptr, 'u', &count);
  if (result == -ETIMEDOUT || result == -ENOTCONN || result == -ECONNRESET) bus_.reset();
  return result >= 0 ? std::optional<std::uint64_t>(count) : std::nullopt;
}

}  // namespace gvom::ctl
