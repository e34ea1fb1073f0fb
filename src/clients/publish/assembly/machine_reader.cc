// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/assembly/machine_reader.hh"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "messages/declarations/names.hh"

namespace mw::publish {
namespace {

constexpr std::int64_t SEARCH_NS = 500'000'000;

std::string kind_name(messages::MessageKind kind) {
    for (const messages::Name &name : messages::NAMES<messages::MessageKind>) {
        if (name.value == static_cast<std::int64_t>(kind)) {
            return name.name;
        }
    }
    return "";
}

}  // namespace

void MachineReader::pass(const std::vector<Change> &changes, TimeMs now) {
    if (changes.empty()) {
        return;
    }
    if (data_ != nullptr) {
        data_->add(changes, now);
    }
    if (agent_ != nullptr) {
        agent_->add(changes, now);
    }
}

void MachineReader::pass_all(TimeMs now) {
    const auto &status = viewer_->status();
    readings_.fit(status);
    const std::vector<Value> values = readings_.all(status);
    if (data_ != nullptr) {
        data_->born(readings_.metrics(), values, now);
    }
    if (agent_ != nullptr) {
        agent_->born(readings_.metrics(), values, status.settings.linear_units, now);
    }
}

void MachineReader::look_for_machine(TimeMs now, std::int64_t steady_ns) {
    if (steady_ns < look_at_ns_) {
        return;
    }
    look_at_ns_ = steady_ns + SEARCH_NS;
    auto found = attach_();
    if (!found.has_value() || !found->read_status().has_value()) {
        return;
    }
    viewer_.emplace(std::move(*found));
    if (mark_.run != viewer_->run()) {
        mark_ = {viewer_->run(), 0};
    }
    viewer_->rewind_messages(mailbox::MAX_MESSAGES);
    pass_all(now);
}

void MachineReader::end(TimeMs now) {
    viewer_.reset();
    if (data_ != nullptr) {
        data_->gone();
    }
    if (agent_ != nullptr) {
        agent_->gone(now);
    }
}

void MachineReader::pass_messages(TimeMs now) {
    const std::uint64_t before = mark_.number;
    while (const auto message = viewer_->next_message(client::Viewer::Reading::LOOKS_ON)) {
        if (message->number > mark_.number) {
            mark_.number = message->number;
            const std::string id = fmt::format("{:016x}-{}", mark_.run, message->number);
            pass(readings_.message(kind_name(message->kind), message->text, id), now);
        }
    }
    // Stored after the message is passed on. After a kill in between, the message is passed on again with the
    // same id.
    if (mark_.number != before && keep_) {
        keep_(mark_);
    }
}

void MachineReader::step(TimeMs now, std::int64_t steady_ns) {
    if (!viewer_.has_value()) {
        look_for_machine(now, steady_ns);
    }
    if (!viewer_.has_value()) {
        return;
    }
    if (!viewer_->isMachineAlive() || !viewer_->read_status().has_value()) {
        end(now);
        return;
    }
    if (readings_.isOther(viewer_->status())) {
        pass_all(now);
    } else {
        pass(readings_.changes(viewer_->status()), now);
    }
    pass_messages(now);
    if (agent_ != nullptr) {
        if (auto tools = viewer_->read_tools(); tools.has_value() && tools->has_value()) {
            agent_->set_tools(**tools, now);
        }
    }
}

}  // namespace mw::publish
