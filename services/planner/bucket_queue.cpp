#include "services/planner/bucket_queue.hpp"

#include <algorithm>

namespace gvom::planner {

BucketQueue::BucketQueue(int items) : links_(items, Links{kNone, kNone}), heads_(kBuckets, kNone) {}

void BucketQueue::clear(float lowest_key, float span, float least_width) {
  std::fill(links_.begin(), links_.end(), Links{kNone, kNone});
  std::fill(heads_.begin(), heads_.end(), kNone);
  bucket_ = 0;
  size_ = 0;
  lowest_key_ = lowest_key;
  width_ = std::max(least_width, span / (kBuckets - 2));
}

void BucketQueue::put(std::int32_t item, float key) {
  if (links_[item].earlier != kNone) unlink(item);
  const auto bucket = std::max(static_cast<std::int64_t>((key - lowest_key_) / width_), bucket_);
  const auto place = static_cast<std::int32_t>(bucket % kBuckets);
  const std::int32_t second = heads_[place];
  links_[item] = {second, kFirst - place};
  if (second != kNone) links_[second].earlier = item;
  heads_[place] = item;
  ++size_;
}

std::int32_t BucketQueue::take() {
  if (size_ == 0) return kNone;
  while (bucket_is_empty()) ++bucket_;
  const std::int32_t item = heads_[bucket_ % kBuckets];
  unlink(item);
  return item;
}

void BucketQueue::unlink(std::int32_t item) {
  const Links links = links_[item];
  if (links.earlier <= kFirst) {
    heads_[kFirst - links.earlier] = links.later;
  } else {
    links_[links.earlier].later = links.later;
  }
  if (links.later != kNone) links_[links.later].earlier = links.earlier;
  links_[item].earlier = kNone;
  --size_;
}

}  // namespace gvom::planner
