#include "services/common/dds/participant.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <dds/dds.h>
#include <spdlog/spdlog.h>

#include "services/common/dds/blob_type.hpp"
#include "services/common/dds/cyclone_log.hpp"
#include "services/common/dds/endpoint.hpp"

namespace gvom::dds {

/// The writer of ros_discovery_info, which belongs to no node itself.
class GraphWriter {
 public:
  static tl::expected<std::unique_ptr<GraphWriter>, std::string> open(dds_entity_t participant,
                                                                      Distro distro);

  void write(ros::Blob message) {
    const dds_return_t code = dds_writecdr(writer_.get(), new_message(topic_.type, std::move(message)));
    if (code < 0) spdlog::warn("ROS 2: the node is not listed: {}", dds_strretcode(code));
  }

 private:
  OpenTopic topic_;
  Entity writer_;
};

namespace {

constexpr const char* kGraphTypeHash =
    "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e";
constexpr std::string_view kEnclave = "enclave=/;";

/// Where there is nothing but the loopback that is the network, as if it were named: else it would be one
/// without multicast.
DomainOptions with_network(DomainOptions domain) {
  if (!domain.interface.empty() || !domain.config_file.empty()) return domain;
  const InterfaceAddresses addresses = usable(interface_addresses(), "");
  if (!is_loopback(addresses)) return domain;
  spdlog::warn("ROS 2: no network but the loopback: only this machine is heard, until there is one");
  domain.interface = addresses.front().name;
  return domain;
}

void erase(std::vector<Guid>& guids, const Guid& guid) {
  guids.erase(std::remove(guids.begin(), guids.end(), guid), guids.end());
}

}  // namespace

tl::expected<std::unique_ptr<GraphWriter>, std::string> GraphWriter::open(dds_entity_t participant,
                                                                          Distro distro) {
  auto made = std::make_unique<GraphWriter>();
  auto topic =
      open_topic(participant, "ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_");
  if (!topic) return tl::unexpected(topic.error());
  made->topic_ = std::move(*topic);
  const QosPtr qos = make_qos(Qos{true, true, 1}, user_data_of(kGraphTypeHash, distro));
  const dds_entity_t writer = dds_create_writer(participant, made->topic_.entity.get(), qos.get(), nullptr);
  if (writer < 0) return tl::unexpected(std::string("the graph's writer: ") + dds_strretcode(writer));
  made->writer_ = Entity(writer);
  return made;
}

/// Cyclone has a domain at most once in a process, and so have we.
struct Participant::Domains {
  std::mutex mutex;
  std::map<int, std::weak_ptr<Participant>> open;

  static Domains& all() {
    static Domains domains;
    return domains;
  }
};

tl::expected<std::shared_ptr<Participant>, std::string> Participant::open(const ParticipantOptions& options) {
  const auto xml = domain_xml(options.domain);
  if (!xml) return tl::unexpected("ROS 2: " + xml.error());
  Domains& domains = Domains::all();
  const std::lock_guard lock(domains.mutex);
  std::weak_ptr<Participant>& known = domains.open[options.domain.id];
  if (auto participant = known.lock()) {
    if (participant->asked_xml_ == *xml && participant->distro_ == options.distro) return participant;
    return tl::unexpected("ROS 2: domain " + std::to_string(options.domain.id) +
                          ": this process is in it already, with other options");
  }
  std::unique_ptr<Participant> participant(new Participant(options));
  participant->asked_xml_ = *xml;
  const auto joined = participant->join(options);
  if (!joined) return tl::unexpected("ROS 2: " + joined.error());
  std::shared_ptr<Participant> shared(participant.release(), leave);
  known = shared;
  return shared;
}

/// Nobody opens the domain anew before it is gone.
void Participant::leave(Participant* participant) {
  const std::lock_guard lock(Domains::all().mutex);
  delete participant;
}

tl::expected<void, std::string> Participant::join(const ParticipantOptions& options) {
  auto node = node_name(options.node);
  if (!node) return tl::unexpected(node.error());
  const auto xml = domain_xml(with_network(options.domain));
  if (!xml) return tl::unexpected(xml.error());
  take_cyclone_log();
  const CycloneWords words;
  const auto failed = [&](const char* what, dds_return_t code) {
    const std::string said = words.text();
    return tl::unexpected("domain " + std::to_string(options.domain.id) + ": " + what + ": " +
                          (said.empty() ? dds_strretcode(code) : said));
  };
  const auto id = static_cast<dds_domainid_t>(options.domain.id);
  domain_ = dds_create_domain(id, xml->c_str());
  if (domain_ == DDS_RETCODE_PRECONDITION_NOT_MET) return failed("this process is in it already", domain_);
  if (domain_ < 0) return failed("Cyclone DDS does not start", domain_);
  const QosPtr qos(dds_create_qos());
  dds_qset_userdata(qos.get(), kEnclave.data(), kEnclave.size());
  participant_ = dds_create_participant(id, qos.get(), nullptr);
  if (participant_ < 0) return failed("no participant", participant_);
  auto graph = GraphWriter::open(participant_, distro_);
  if (!graph) return tl::unexpected(graph.error());
  graph_ = std::move(*graph);
  entities_.participant = guid_of(participant_);
  entities_.node = std::move(*node);
  tell_graph();
  return {};
}

Participant::Participant(const ParticipantOptions& options)
    : distro_(options.distro), network_(options.domain.interface, options.domain.config_file.empty()) {}

Participant::~Participant() {
  graph_.reset();
  if (domain_ > 0) dds_delete(domain_);
}

void Participant::tell_graph() {
  graph_->write(graph_message(entities_, distro_));
}

void Participant::add_reader(const Guid& reader) {
  const std::lock_guard lock(mutex_);
  entities_.readers.push_back(reader);
  tell_graph();
}

void Participant::add_writer(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  entities_.writers.push_back(writer);
  tell_graph();
}

void Participant::remove(const Guid& reader_or_writer) {
  const std::lock_guard lock(mutex_);
  erase(entities_.readers, reader_or_writer);
  erase(entities_.writers, reader_or_writer);
  tell_graph();
}

}  // namespace gvom::dds
