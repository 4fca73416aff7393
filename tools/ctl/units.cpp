#include "tools/ctl/units.hpp"

#include <systemd/sd-bus.h>
#include <systemd/sd-daemon.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

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

constexpr char kUnit[] = "org.freedesktop.systemd1.Unit";
constexpr char kService[] = "org.freedesktop.systemd1.Service";

struct Text {
  char* text = nullptr;
  ~Text() { std::free(text); }
};

std::string path_of(const std::string& unit) {
  Text path;
  const int result = sd_bus_path_encode("/org/freedesktop/systemd1/unit", unit.c_str(), &path.text);
  return result >= 0 ? path.text : "";
}

bool is_lost(int result) {
  return result == -ETIMEDOUT || result == -ENOTCONN || result == -ECONNRESET;
}

}  // namespace

std::string unit_of(const std::string& process) {
  const std::string lidar = tools::lidar_of(process);
  return lidar.empty() ? process + ".service" : "gvom-ingest@" + lidar + ".service";
}

void Units::Close::operator()(sd_bus* bus) const {
  sd_bus_close_unref(bus);
}

Units::Units() : bus_(open_bus()) {}

std::string Units::text(const std::string& path, const char* interface, const char* property) {
  Text value;
  if (!bus_) return "";
  const int result = sd_bus_get_property_string(bus_.get(), kSystemd, path.c_str(), interface, property,
                                                nullptr, &value.text);
  if (is_lost(result)) bus_.reset();
  return result >= 0 ? value.text : "";
}

std::optional<std::uint64_t> Units::restarts(const std::string& process) {
  const std::string path = path_of(unit_of(process));
  if (text(path, kUnit, "LoadState") != "loaded") return std::nullopt;
  std::uint32_t count = 0;
  const int result = sd_bus_get_property_trivial(bus_.get(), kSystemd, path.c_str(), kService, "NRestarts",
                                                 nullptr, 'u', &count);
  if (is_lost(result)) bus_.reset();
  return result >= 0 ? std::optional<std::uint64_t>(count) : std::nullopt;
}

std::optional<UnitState> Units::state(const std::string& process) {
  const std::string unit = unit_of(process);
  const std::string path = path_of(unit);
  UnitState state;
  state.unit = unit;
  state.load = text(path, kUnit, "LoadState");
  if (state.load.empty()) return std::nullopt;
  state.file = text(path, kUnit, "UnitFileState");
  state.active = text(path, kUnit, "ActiveState");
  state.sub = text(path, kUnit, "SubState");
  state.result = text(path, kService, "Result");
  state.status = text(path, kService, "StatusText");
  if (bus_)
    sd_bus_get_property_trivial(bus_.get(), kSystemd, path.c_str(), kService, "ExecMainStatus", nullptr, 'i',
                                &state.exit_status);
  return state;
}

std::optional<std::string> Units::order(const char* method, const std::string& unit) {
  if (!bus_) return "systemd does not answer";
  sd_bus_error error = SD_BUS_ERROR_NULL;
  const int result = sd_bus_call_method(bus_.get(), kSystemd, "/org/freedesktop/systemd1",
                                        "org.freedesktop.systemd1.Manager", method, &error, nullptr, "ss",
                                        unit.c_str(), "replace");
  const std::string message = error.message != nullptr ? error.message : std::strerror(-result);
  sd_bus_error_free(&error);
  return result >= 0 ? std::nullopt : std::optional(message);
}

}  // namespace gvom::ctl
