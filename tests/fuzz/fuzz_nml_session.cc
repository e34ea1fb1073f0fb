// SPDX-License-Identifier: GPL-2.0-or-later
// Packets of clients to an NML server on the network, one after the other.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "base/diagnostics/sink.hh"
#include "clients/nml/config/config_file.hh"
#include "clients/nml/net/session.hh"

namespace {

using namespace mw::nml;

constexpr std::string_view CHANNELS = "B a LOCMEM localhost 2000 0 0 1 4 1 TCP=1 queue\n"
                                      "B b LOCMEM localhost 2000 0 0 2 4 2 TCP=1 disp\n"
                                      "P s a LOCAL localhost RW 1 0 1 0\nP s b LOCAL localhost RW 1 0 1 0\n";

/// The side of the server, created once, because the masters keep the memory.
struct Rig {
    Rig() {
        mw::diagnostics::Sink sink;
        config = parse_config(CHANNELS, "fuzz.nml", sink);
        for (const BufferSettings &buffer : config.buffers) {
            masters.push_back(*open_buffer(buffer, config.processes[0], "fuzz", local));
            ServedBuffer served{buffer, config.processes[0], {}};
            served.process.isMaster = false;
            service.buffers.emplace(static_cast<std::uint32_t>(buffer.buffer_number), std::move(served));
        }
    }
    Vocabulary vocabulary = Vocabulary::standard();
    LocalPlaces local;
    Config config;
    std::vector<std::unique_ptr<Buffer>> masters;
    Service service{{}, vocabulary, "fuzz", local, 2000};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    static Rig rig;
    std::string_view bytes(reinterpret_cast<const char *>(data), size);
    Session session(rig.service);
    while (bytes.size() >= PACKET_HEAD) {
        std::size_t follows = 0;
        auto request = read_packet_head(bytes, follows);
        if (!request.has_value() || follows > bytes.size() - PACKET_HEAD) {
            break;
        }
        request->bytes = bytes.substr(PACKET_HEAD, follows);
        request->time_ms = 0;
        bytes.remove_prefix(PACKET_HEAD + follows);
        const Packet answer = session.answer(*request, [] { return true; });
        std::size_t sent = 0;
        const auto read = read_packet_head(to_wire(answer), sent);
        if (!read.has_value() || answer.status == Status::REQUEST || answer.request != request->request ||
            sent != answer.bytes.size()) {
            std::abort();
        }
    }
    return 0;
}
