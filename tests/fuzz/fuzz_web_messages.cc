// SPDX-License-Identifier: GPL-2.0-or-later
// Input of browsers to the web interface behind HTTP: texts of a web socket and requests, one on each line. A
// line that begins with '/' is a request: method (first letter of the next word), path, body. Any other line
// is a text. The first byte is the role of the client.
#include <cstdint>
#include <string_view>

#include "tests/fuzz/web_rig.hh"

namespace {

using namespace mw;

class Deaf final : public screen::Sockets {
  public:
    void send(screen::SessionId, std::string text) override { bytes += text.size(); }
    bool isIdle(screen::SessionId) const override { return true; }
    void close(screen::SessionId) override { ++closed; }
    std::size_t bytes = 0, closed = 0;
};

void ask(screen::Api &api, std::string_view line, screen::Role role) {
    const std::size_t end = line.find(' ');
    auto request = screen::parse_target(line.substr(0, end));
    if (!request.has_value()) {
        return;
    }
    std::string_view rest = end == std::string_view::npos ? "" : line.substr(end + 1);
    const char letter = rest.empty() ? 'g' : rest[0];
    request->method = letter == 'p' ? "PUT" : letter == 'o' ? "POST" : letter == 'd' ? "DELETE" : "GET";
    request->body = rest.empty() ? "" : rest.substr(1);
    request->role = role;
    int answers = 0;
    api.answer(*request, [&](const screen::Response &response) {
        ++answers;
        if (response.status < 200 || response.status > 599) {
            std::abort();
        }
    });
    if (answers != 1) {
        std::abort();  // each request has one answer
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    if (size < 1) {
        return 0;
    }
    static fuzz::WebRig rig;
    const auto role = static_cast<screen::Role>(1 + data[0] % 3);
    std::string_view text(reinterpret_cast<const char *>(data) + 1, size - 1);
    Deaf deaf;
    auto api = rig.api(deaf);
    api->opened(1, role, screen::Protection::TLS);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.starts_with('/')) {
            ask(*api, line, role);
        } else {
            api->received(1, line);
        }
        rig.cycle();
        api->tick();
    }
    api->closed(1);
    return 0;
}
