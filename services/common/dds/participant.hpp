// This process as a node of ROS 2.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include <tl/expected.hpp>

#include "services/common/dds/domain.hpp"
#include "services/common/dds/graph.hpp"
#include "services/common/dds/names.hpp"
#include "services/common/dds/network_watch.hpp"

namespace gvom::dds {

struct ParticipantOptions {
  DomainOptions domain;
  std::string node = "/gvom";  ///< Its full name.
  Distro distro = Distro::jazzy;
};

class GraphWriter;

/// One for each domain in a process, shared by all who open it; the first one's `node` is its name. Writers
/// and readers keep it alive. For any thread.
class Participant {
 public:
  /// Joins the network. Errors: what domain_xml refuses, a domain that this process is in already, an
  /// interface that is not there, a configuration that Cyclone refuses (in its own words).
  static tl::expected<std::shared_ptr<Participant>, std::string> open(const ParticipantOptions& options);

  /// Leaves it.
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  [[nodiscard]] const Guid& guid() const { return entities_.participant; }
  [[nodiscard]] Distro distro() const { return distro_; }
  /// Why nobody can be reached any more, and this has to be opened anew when all have let it go: its
  /// interface went down or away, or has another address; or it was the loopback, and a network has come.
  /// Empty if all is well. Cheap.
  [[nodiscard]] std::string network_loss() { return network_.loss(); }
  [[nodiscard]] std::int32_t handle() const { return participant_; }  ///< Cyclone's.

  // Of this node's readers and writers; the graph is told.
  void add_reader(const Guid& reader);
  void add_writer(const Guid& writer);
  void remove(const Guid& reader_or_writer);

 private:
  struct Domains;

  explicit Participant(const ParticipantOptions& options);
  static void leave(Participant* participant);
  tl::expected<void, std::string> join(const ParticipantOptions& options);
  void tell_graph();

  const Distro distro_;
  NetworkWatch network_;  // what was there just before it joined
  std::string asked_xml_;
  std::int32_t domain_ = 0;  // handles of Cyclone's
  std::int32_t participant_ = 0;
  std::mutex mutex_;  // of what follows
  NodeEntities entities_;
  std::unique_ptr<GraphWriter> graph_;
};

}  // namespace gvom::dds
