// How fast the device copies: what its other figures are held against.
#include <algorithm>
#include <vector>

#include "core/cuda/device.hpp"
#include "core/cuda/open.hpp"

namespace gvom::cuda {

namespace {

constexpr std::size_t kBytes = std::size_t{256} << 20;
constexpr int kRepeats = 11;

// The median rate of a copy of `kBytes`, bytes per second.
template <class Copy>
double rate(Device& device, Copy&& copy) {
  std::vector<double> ms;
  for (int i = 0; i < kRepeats; ++i) {
    device.mark(0);
    copy();
    device.mark(1);
    if (!device.wait()) return 0;
    ms.push_back(device.ms_between(0, 1));
  }
  std::sort(ms.begin(), ms.end());
  return static_cast<double>(kBytes) / (ms[kRepeats / 2] * 1e-3);
}

}  // namespace

DeviceExpected<CopyRates> measure_copies() {
  auto device = Device::open();
  if (!device) return tl::make_unexpected(device.error());
  Device& d = **device;
  auto* host = d.pinned_array<std::byte>(kBytes);
  auto* a = d.array<std::byte>(kBytes);
  auto* b = d.array<std::byte>(kBytes);
  const CopyRates rates{rate(d, [&] { d.upload(a, host, kBytes); }),
                        rate(d, [&] { d.download(host, a, kBytes); }),
                        2 * rate(d, [&] { d.copy(b, a, kBytes); })};
  if (d.failed()) return tl::make_unexpected(d.failure());
  return rates;
}

}  // namespace gvom::cuda
