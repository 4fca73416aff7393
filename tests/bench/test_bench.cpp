// gvom-bench --gpu from end to end, on the fake device.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/temporary_folder.hpp"

namespace gvom::test {
namespace {

using Json = nlohmann::json;

/// The exit code; what it says goes to `log`.
int bench(const std::string& arguments, const std::string& log, const std::string& environment = "") {
  const std::string command = environment + " '" GVOM_BENCH_SERIAL "' " + arguments + " > '" + log + "' 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string contents(const std::string& path) {
  std::ostringstream all;
  all << std::ifstream(path).rdbuf();
  return all.str();
}

void check_times(const Json& times, int runs) {
  CHECK(times.at("runs") == runs);
  CHECK(times.at("p50_ms").get<double>() >= 0);
  CHECK(times.at("p99_ms").get<double>() >= times.at("p50_ms").get<double>());
}

TEST_CASE("the GPU is measured beside the CPU") {
  const TemporaryFolder folder;
  const std::string log = folder.path() + "/log", json = folder.path() + "/bench.json";
  const std::string summary = folder.path() + "/summary.txt";
  const int code = bench(
      "--gpu --quick --repeats 1 --lidar os1-128 --json '" + json + "' --summary '" + summary + "'", log);
  INFO(contents(log));
  REQUIRE(code == 0);
  const Json run = Json::parse(contents(json));
  CHECK(run.at("sweeps") == 11);
  CHECK(run.at("device").get<std::string>().find("fake device") == 0);
  CHECK(run.at("command").get<std::string>().find("gvom-bench --gpu --quick") == 0);
  for (const char* rate : {"to_device", "to_host", "within_device"})
    CHECK(run.at("copy_bytes_per_s").at(rate).get<double>() > 0);
  for (const char* step : {"count", "write", "both"}) {
    check_times(run.at("voxelizing").at("cpu").at(step), 11);  // each sweep once, and 4 for a repeat if more
    check_times(run.at("voxelizing").at("cuda").at(step), 20);
  }
  REQUIRE(run.at("ticks").size() == 1);
  const Json& tick = run.at("ticks")[0];
  CHECK(tick.at("grid") == Json{{"size_xy", 64}, {"size_z", 32}});
  for (const char* step : {"tick", "fuse", "layers"}) check_times(tick.at("cpu").at(step), 4);
  const Json& cuda = tick.at("cuda");
  check_times(cuda.at("tick"), 20);
  CHECK(cuda.at("launches") >= 2);
  for (const char* stage : {"upload", "fuse", "layers", "download"}) {
    check_times(cuda.at(stage), 20);
    CHECK(cuda.at(stage).at("share_of_copy_rate").get<double>() >= 0);
  }
  // Of 64 x 64 columns: 43 bytes of layers, 28 of masks, stamp and lowest ray read, 12 more where there is
  // ground.
  CHECK(cuda.at("download").at("least_bytes") == 4096 * 43);
  CHECK(cuda.at("layers").at("least_bytes").get<double>() >= 4096 * (43 + 28));
  CHECK(cuda.at("layers").at("least_bytes").get<double>() <= 4096 * (43 + 28 + 12));
  CHECK(cuda.at("upload").at("least_bytes").get<double>() > 2 * 4096);
  // Two maps are read, each about as large as the one that is sent, and 6 KB of a brick twice for 2 KB sent.
  CHECK(cuda.at("fuse").at("least_bytes") > cuda.at("upload").at("least_bytes"));
  // In 20 ticks: 6 or 7 bricks along x, and 3 or 4 up or down, in layers of 8 x 4 and 8 x 8.
  CHECK(tick.at("bricks_entering").get<double>() > (6 * 32 + 3 * 64 - 40) / 20.0);
  CHECK(tick.at("bricks_entering").get<double>() <= (8 * 32 + 4 * 64) / 20.0);
  CHECK(cuda.at("floor_ms").get<double>() > 0);
  CHECK(cuda.at("bytes_down") == 4096 * 43);
  CHECK(cuda.at("bytes_up").get<double>() >= cuda.at("upload").at("least_bytes").get<double>());
  const Json& kernels = run.at("kernels");
  for (const char* kernel : {"ClearTouched", "WriteColumns", "running sum"})
    check_times(kernels.at("a sweep, 64 x 64 x 32").at(kernel), 11);
  CHECK(kernels.at("a tick, 64 x 64 x 32, window 2").size() == 14);
  for (const char* kernel :
       {"ListChangedBricks", "UpdateBricks", "UpdateLastSeen", "UpdateLowestRays", "JudgeColumns"})
    check_times(kernels.at("a tick, 64 x 64 x 32, window 2").at(kernel), 4);
  CHECK(contents(log).find("| 64 x 64 x 32 | 2 |") != std::string::npos);
  CHECK(contents(summary).find("\n64 x 64 x 32        2 ") != std::string::npos);
  CHECK(contents(summary).size() < 2500);
}

TEST_CASE("the GPU is held until standard input ends, after a line that says what it is") {
  const TemporaryFolder folder;
  const std::string log = folder.path() + "/log";
  CHECK(bench("--hold-gpu < /dev/null", log) == 0);
  CHECK(contents(log).find(
            "fake device on the host (compute capability 0.0, driver for CUDA 13.0): opened in ") == 0);
  CHECK(bench("--hold-gpu < /dev/null", log, "GVOM_SERIAL_DEVICE_FAIL_AT=1") == 69);
  CHECK(contents(log) == "gvom-bench: cudaStreamSynchronize: an illegal memory access was encountered\n");
  const std::string endless = "'" + folder.path() + "/endless'";
  CHECK(bench("--hold-gpu <> " + endless, log, "mkfifo " + endless + " && timeout 0.5 env") == 124);
}

TEST_CASE("a device that cannot be used is no figure but exit 69 and its words") {
  const TemporaryFolder folder;
  const std::string log = folder.path() + "/log";
  CHECK(bench("--gpu --quick --repeats 1", log, "GVOM_SERIAL_DEVICE_FAIL_AT=100") == 69);
  CHECK(contents(log) == "gvom-bench: cudaStreamSynchronize: an illegal memory access was encountered\n");
}

TEST_CASE("a wrong command line is exit 64") {
  const TemporaryFolder folder;
  const std::string log = folder.path() + "/log";
  CHECK(bench("--quick", log) == 64);
  CHECK(bench("--lidar os1-129", log) == 64);
  CHECK(bench("--lidar os1-128 --sweeps /", log) == 64);
}

}  // namespace
}  // namespace gvom::test
