// SPDX-License-Identifier: GPL-2.0-or-later
// Input of clients to linuxcncrsh, in pieces; the first byte selects the dialect, the second the time at
// which the machine is on.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "clients/rsh/session.hh"
#include "messages/mailbox/command_server.hh"

namespace {

using namespace mw;
using namespace mw::rsh;

/// A machine whose task answers every second command, at once or later.
struct Rig {
    Rig() {
        status->trajectory.num_joints = settings.num_joints;
        step(true);
        shared.emplace(client::Viewer(memory.segment()));
    }
    void step(bool isAnswering) {
        for (const auto &delivery : desk.take(now_ns += 1000000)) {
            const auto progress =
                delivery.serial % 2 == 0 ? messages::Progress::DONE : messages::Progress::REFUSED;
            if (isAnswering) {
                desk.tell(delivery.serial, progress, "no");
            }
        }
        ++status->cycle;
        desk.publish(*status);
    }
    Settings settings;
    mailbox::Memory memory = mailbox::Memory::in_process();
    mailbox::CommandServer desk{memory.segment()};
    std::unique_ptr<messages::MachineStatus> status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 0;
    std::optional<SharedView> shared;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    constexpr std::size_t PIECE = 37;
    constexpr std::size_t HEAD = 2;
    if (size < HEAD) {
        return 0;
    }
    static Rig rig;
    rig.settings.dialect = data[0] % 2 == 0 ? Dialect::NEWER : Dialect::OLD;
    rig.status->task.state = data[1] % 4 != 0 ? messages::State::ON : messages::State::OFF;
    std::string_view bytes(reinterpret_cast<const char *>(data) + HEAD, size - HEAD);
    Session session(rig.settings, *rig.shared, [] { return client::Client::join(rig.memory.segment()); });
    session.take("hello EMC f 1\nset enable EMCTOO\nset timeout 0.05\n");
    std::size_t sent = 0;
    while (!bytes.empty() && !session.isOver()) {
        session.take(bytes.substr(0, PIECE));
        bytes.remove_prefix(std::min(PIECE, bytes.size()));
        rig.step(data[0] % 3 != 0);
        if (!rig.shared->read().has_value()) {
            std::abort();
        }
        session.step(static_cast<double>(rig.now_ns) * 1e-9);
        sent += session.output().size();
        session.output().clear();
    }
    session.end_input();
    // Every session ends: each wait has a time limit.
    for (int i = 0; i < 200000 && !session.isOver(); ++i) {
        rig.step(true);
        if (!rig.shared->read().has_value()) {
            std::abort();
        }
        session.step(static_cast<double>(rig.now_ns) * 1e-9);
        session.output().clear();
    }
    constexpr std::size_t MOST = 100UL * 1024 * 1024;
    if (!session.isOver() || sent > MOST) {
        std::abort();
    }
    return 0;
}
