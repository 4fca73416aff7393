#include "services/ingest/cloud_points.hpp"

#include <algorithm>

namespace gvom::ingest {

tl::expected<Hits, std::string> take_points(const PcdCloud& cloud, std::size_t count, Sweep& out,
                                            std::vector<bool>& is_hit) {
  const PcdField* const axes[3] = {cloud.find("x"), cloud.find("y"), cloud.find("z")};
  for (const PcdField* axis : axes) {
    if (axis == nullptr || axis->type != 'F' || axis->count != 1)
      return tl::unexpected(std::string("no floating-point fields x, y, z"));
  }
  Hits hits;
  is_hit.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Return r{cloud.number(*axes[0], i), cloud.number(*axes[1], i), cloud.number(*axes[2], i), 0};
    is_hit[i] = hits.add(r.x_m, r.y_m, r.z_m);
    out.returns.push_back(r);
  }
  return hits.judge().map([&] { return hits; });
}

void set_times(const std::vector<std::int64_t>& times_ns, std::int64_t stamp_ns, Sweep& out) {
  out.times_ns = times_ns;
  if (out.returns.empty()) out.times_ns.push_back(stamp_ns);
  std::sort(out.times_ns.begin(), out.times_ns.end());
  out.times_ns.erase(std::unique(out.times_ns.begin(), out.times_ns.end()), out.times_ns.end());
  out.stamp_ns = out.times_ns.back();
  for (std::size_t i = 0; i < out.returns.size(); ++i) {
    const auto at = std::lower_bound(out.times_ns.begin(), out.times_ns.end(), times_ns[i]);
    out.returns[i].time_index = static_cast<std::uint32_t>(at - out.times_ns.begin());
  }
}

}  // namespace gvom::ingest
