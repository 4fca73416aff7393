#include "services/ingest/cloud_sweep.hpp"

#include <algorithm>
#include <utility>

#include "services/ingest/cloud_points.hpp"

namespace gvom::ingest {
namespace {

using Result = tl::expected<void, std::string>;

constexpr std::uint32_t kMostPointBytes = 4096;

struct Datatype {
  char type;  // as PcdField has it
  std::size_t bytes;
};

std::optional<Datatype> datatype_of(const ros::PointFieldIn& field) {
  using Field = ros::PointFieldIn;
  switch (field.datatype) {
    case Field::int8:
      return Datatype{'I', 1};
    case Field::uint8:
      return Datatype{'U', 1};
    case Field::int16:
      return Datatype{'I', 2};
    case Field::uint16:
      return Datatype{'U', 2};
    case Field::int32:
      return Datatype{'I', 4};
    case Field::uint32:
      return Datatype{'U', 4};
    case Field::float32:
      return Datatype{'F', 4};
    case Field::float64:
      return Datatype{'F', 8};
    default:
      return std::nullopt;
  }
}

std::string names_of(const PcdCloud& cloud) {
  std::string names;
  for (const PcdField& field : cloud.fields) names += (names.empty() ? "" : ", ") + field.name;
  return names;
}

/// Whether the data hold all rows; products can't overflow 64 bits: both factors have 32.
Result check_size(const ros::PointCloud2In& cloud) {
  if (cloud.point_step == 0 || cloud.point_step > kMostPointBytes)
    return tl::unexpected("point_step is " + std::to_string(cloud.point_step));
  const std::uint64_t row_bytes = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step < row_bytes)
    return tl::unexpected("row_step is " + std::to_string(cloud.row_step) + ", a row has " +
                          std::to_string(row_bytes) + " bytes");
  if (cloud.height == 0 || cloud.width == 0) return {};
  const std::uint64_t before_last = std::uint64_t{cloud.height - 1} * cloud.row_step;
  if (before_last <= cloud.data.size && row_bytes <= cloud.data.size - before_last) return {};
  return tl::unexpected("its data have " + std::to_string(cloud.data.size) + " bytes, too few for " +
                        std::to_string(cloud.height) + " rows of " + std::to_string(cloud.width) + " points");
}

}  // namespace

tl::expected<CloudOptions, std::string> cloud_options(const services::SourceUri& uri,
                                                      std::size_t max_returns) {
  CloudOptions options{max_returns, {}};
  const auto wrong = [&](const std::string& what) {
    return tl::unexpected("source '" + uri.text + "': " + what);
  };
  if (const auto text = uri.option("time")) {
    options.time = parse_time_unit(*text);
    if (!options.time) return wrong("time=" + *text + ": expected ns, us, ms, s or none");
  }
  if (const auto text = uri.option("deskew")) {
    if (*text != "off") return wrong("deskew=" + *text + ": expected off");
    if (options.time) return wrong("time and deskew=off exclude each other");
    options.time = TimeUnit::none;
  }
  return options;
}

CloudSweep::CloudSweep(const CloudOptions& options, std::string topic, const std::string& scheme)
    : options_(options),
      topic_(std::move(topic)),
      time_option_(scheme + ":...&time="),
      times_(options.time) {}

Result CloudSweep::make(const ros::PointCloud2In& cloud, SourceState& state, Sweep& out) {
  out.clear();
  if (const auto viewed = view(cloud); !viewed) return viewed;
  if (options_.time != TimeUnit::none && PointTimes::find_time(points_) == nullptr) {
    return tl::unexpected("its points have no times (t, time, timestamp or the like) among " +
                          names_of(points_) +
                          ": such a cloud can't be deskewed; deskew=off maps it all the same");
  }
  const std::size_t count = limit(state);
  const auto hits = take_points(points_, count, out, is_hit_);
  if (!hits) return tl::unexpected(hits.error());
  if (const auto timed = times_.read({points_, is_hit_, cloud.header.stamp_ns, topic_, time_option_},
                                     point_times_ns_, state.warnings);
      !timed)
    return timed;
  set_times(point_times_ns_, cloud.header.stamp_ns, out);
  return {};
}

/// Points that a sweep has no room for are counted.
std::size_t CloudSweep::limit(SourceState& state) {
  const std::size_t taken = std::min(points_.points, options_.max_returns);
  const std::size_t left = points_.points - taken;
  if (left > 0 && state.counters.overflow_returns == 0)
    state.warnings.push_back(topic_ + ": " + std::to_string(points_.points) +
                             " points, of which max_returns takes " + std::to_string(taken));
  state.counters.overflow_returns += left;
  return taken;
}

Result CloudSweep::view(const ros::PointCloud2In& cloud) {
  if (const auto checked = check_size(cloud); !checked) return checked;
  points_.fields.clear();
  points_.points = std::size_t{cloud.width} * cloud.height;
  for (const ros::PointFieldIn& field : cloud.fields)
    if (const auto added = add_field(cloud, field); !added) return added;
  const bool has_gaps = cloud.height > 1 && cloud.row_step != cloud.width * cloud.point_step;
  points_.body = {cloud.data.data, cloud.data.size};
  if (cloud.is_bigendian || has_gaps) copy_points(cloud);
  return {};
}

Result CloudSweep::add_field(const ros::PointCloud2In& cloud, const ros::PointFieldIn& field) {
  const std::string name(field.name);
  const auto datatype = datatype_of(field);
  if (!datatype)
    return tl::unexpected("field '" + name + "' has the unknown datatype " + std::to_string(field.datatype));
  const std::uint64_t bytes = std::uint64_t{field.count} * datatype->bytes;
  if (field.offset_bytes > cloud.point_step || bytes > cloud.point_step - field.offset_bytes)
    return tl::unexpected("field '" + name + "' does not lie within a point of " +
                          std::to_string(cloud.point_step) + " bytes");
  points_.fields.push_back(
      {name, datatype->type, datatype->bytes, field.count, field.offset_bytes, cloud.point_step});
  return {};
}

/// Row by row, and each number in this machine's order.
void CloudSweep::copy_points(const ros::PointCloud2In& cloud) {
  const std::size_t row_bytes = std::size_t{cloud.width} * cloud.point_step;
  ordered_.resize(points_.points * cloud.point_step);
  for (std::size_t row = 0; row < cloud.height && cloud.width > 0; ++row)
    std::copy_n(cloud.data.data + row * cloud.row_step, row_bytes, ordered_.data() + row * row_bytes);
  points_.body = {ordered_.data(), ordered_.size()};
  if (!cloud.is_bigendian) return;
  for (const PcdField& field : points_.fields) {
    for (std::size_t point = 0; point < points_.points; ++point) {
      std::uint8_t* const first = ordered_.data() + point * field.stride + field.offset;
      for (std::size_t value = 0; value < field.count; ++value)
        std::reverse(first + value * field.size, first + (value + 1) * field.size);
    }
  }
}

}  // namespace gvom::ingest
