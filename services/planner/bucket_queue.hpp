// Which of many items comes next, to within a width.
#pragma once

#include <cstdint>
#include <vector>

namespace gvom::planner {

/// Items by key, lowest first, in a ring of buckets that are each `width` wide (Dial, Algorithm 360, 1969).
/// Within a bucket the item that came last is taken first. Each item is in it once: to put it again moves it.
class BucketQueue {
 public:
  static constexpr int kBuckets = 2048;
  static constexpr std::int32_t kNone = -1;

  /// @param items numbered 0 .. items - 1
  explicit BucketQueue(int items);

  /// Empties it. @param span the most by which a key is over the lowest one that is in it, ever
  /// @param least_width that a bucket has
  void clear(float lowest_key, float span, float least_width);
  /// A key below those of the bucket that is being taken counts as one of its.
  void put(std::int32_t item, float key);
  /// kNone: it is empty.
  std::int32_t take();
  /// The number of the bucket that is being taken, from 0.
  [[nodiscard]] std::int64_t bucket() const { return bucket_; }
  /// Whether nothing is left of that bucket.
  [[nodiscard]] bool bucket_is_empty() const { return heads_[bucket_ % kBuckets] == kNone; }

 private:
  struct Links {
    std::int32_t later;  ///< The next in its bucket, or kNone.
    std::int32_t
        earlier;  ///< The one before; of the first, kFirst - the bucket's place; kNone: in no bucket.
  };
  static constexpr std::int32_t kFirst = -2;
  void unlink(std::int32_t item);

  std::vector<Links> links_;
  std::vector<std::int32_t> heads_;
  std::int64_t bucket_ = 0;
  int size_ = 0;
  float lowest_key_ = 0;
  float width_ = 1;
};

}  // namespace gvom::planner
