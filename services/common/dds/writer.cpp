#include "services/common/dds/writer.hpp"

#include <utility>

#include <dds/dds.h>

#include "services/common/dds/blob_type.hpp"
#include "services/common/dds/endpoint.hpp"

namespace gvom::dds {

struct Writer::State {
  std::shared_ptr<Participant> participant;
  OpenTopic topic;
  Entity entity;  // deleted before its topic
  Guid guid{};

  ~State() {
    if (entity.valid()) participant->remove(guid);
  }
};

Writer::Writer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Writer::~Writer() = default;
Writer::Writer(Writer&&) noexcept = default;
Writer& Writer::operator=(Writer&&) noexcept = default;

tl::expected<Writer, std::string> Writer::open(std::shared_ptr<Participant> participant, const Topic& topic,
                                               const Qos& qos) {
  auto opened = open_topic(participant->handle(), topic);
  if (!opened) return tl::unexpected(opened.error());
  auto state = std::make_unique<State>();
  state->participant = std::move(participant);
  state->topic = std::move(*opened);
  const QosPtr wanted = make_qos(qos, user_data_of(topic.type_hash, state->participant->distro()));
  const dds_entity_t made =
      dds_create_writer(state->participant->handle(), state->topic.entity.get(), wanted.get(), nullptr);
  if (made < 0) return tl::unexpected("a writer of " + topic.name + ": " + dds_strretcode(made));
  state->entity = Entity(made);
  state->guid = guid_of(made);
  state->participant->add_writer(state->guid);
  return Writer(std::move(state));
}

tl::expected<void, std::string> Writer::write(ros::Blob cdr) {
  if (!cdr || cdr->size() < 4) return tl::unexpected(std::string("a message without its head of four bytes"));
  if (cdr->size() > kLargestMessage)
    return tl::unexpected("a message of " + std::to_string(cdr->size()) + " bytes, more than " +
                          std::to_string(kLargestMessage));
  ddsi_serdata* const message = new_message(state_->topic.type, std::move(cdr));
  if (message == nullptr) return tl::unexpected(std::string("no memory for a message"));
  const dds_return_t code = dds_writecdr(state_->entity.get(), message);
  if (code < 0) return tl::unexpected(std::string("not sent: ") + dds_strretcode(code));
  return {};
}

int Writer::subscribers() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(state_->entity.get(), &status);
  return static_cast<int>(status.current_count);
}

const Guid& Writer::guid() const {
  return state_->guid;
}

}  // namespace gvom::dds
