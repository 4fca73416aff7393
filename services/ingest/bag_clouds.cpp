#include "services/ingest/bag_clouds.hpp"

#include <utility>

#include "services/ingest/arrival_clock.hpp"

namespace gvom::ingest {

tl::expected<std::unique_ptr<Source>, std::string> BagClouds::open(bag::BagReader bag,
                                                                   const std::string& name,
                                                                   const CloudOptions& options,
                                                                   std::int64_t clock_offset_ns) {
  std::unique_ptr<BagClouds> source(new BagClouds(std::move(bag), name, options, clock_offset_ns));
  if (const auto judged = source->judge_first(); !judged) return tl::unexpected(judged.error());
  return source;
}

BagClouds::BagClouds(bag::BagReader bag, const std::string& name, const CloudOptions& options,
                     std::int64_t clock_offset_ns)
    : bag_(std::move(bag)), name_(name), sweeps_(options, name, "bag"), clock_offset_ns_(clock_offset_ns) {}

tl::expected<void, std::string> BagClouds::judge_first() {
  bag::Message message;
  Sweep sweep;
  std::string unreadable;  // the first; counted when it is mapped
  while (bag_.next(message)) {
    const std::string which = name_ + ": message " + std::to_string(message.number) + ": ";
    if (const auto read = ros::read_point_cloud(message.data, cloud_); !read) {
      if (unreadable.empty()) unreadable = which + read.error();
      continue;
    }
    if (const auto made = sweeps_.make(cloud_, state_, sweep); !made)
      return tl::unexpected(which + made.error());
    state_.counters = {};
    bag_.rewind();
    return {};
  }
  return tl::unexpected(unreadable.empty() ? name_ + ": has no messages" : unreadable);
}

tl::expected<void, std::string> BagClouds::make(const bag::Message& message, Sweep& out) {
  out.clear();
  const auto read = ros::read_point_cloud(message.data, cloud_);
  return read ? sweeps_.make(cloud_, state_, out) : read;
}

tl::expected<SourceEvent, std::string> BagClouds::next(Sweep& out, std::chrono::milliseconds) {
  for (;;) {
    bag::Message message;
    const bool more = bag_.next(message);
    while (warnings_told_ < bag_.warnings().size())
      state_.warnings.push_back(bag_.warnings()[warnings_told_++]);
    if (!more) return out.clear(), SourceEvent::kEnd;
    ++state_.counters.packets;
    if (const auto made = make(message, out); !made) {
      unused_.add(state_, name_ + ": message " + std::to_string(message.number), made.error(),
                  message.data.size);
      continue;
    }
    shift(out, clock_offset_ns_);
    ++state_.counters.sweeps;
    return SourceEvent::kSweep;
  }
}

tl::expected<void, std::string> BagClouds::rewind() {
  bag_.rewind();
  return {};
}

}  // namespace gvom::ingest
