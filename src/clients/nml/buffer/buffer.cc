// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/buffer/buffer.hh"

#include <fmt/format.h>

namespace mw::nml {

std::unexpected<Error> Buffer::bad(const std::string &what, const std::string &hint) const {
    return fail(fmt::format("buffer '{}': {}", name_, what), {}, hint);
}

Result<> Buffer::need_read() const {
    return rights_.mayRead ? Result<>{} : bad("this process may not read it", "see ops in its P line");
}

Result<> Buffer::need_write() const {
    return rights_.mayWrite ? Result<>{} : bad("this process may not write to it", "see ops in its P line");
}

Result<WriteNumber> Buffer::write(std::string_view bytes, Timeout timeout) {
    const auto allowed = need_write();
    return allowed.has_value() ? put(bytes, timeout) : std::unexpected(allowed.error());
}

Result<bool> Buffer::read(Received &message, Timeout timeout) {
    const auto allowed = need_read();
    return allowed.has_value() ? take(message, timeout) : std::unexpected(allowed.error());
}

Result<bool> Buffer::peek(Received &message, Timeout timeout) {
    const auto allowed = need_read();
    return allowed.has_value() ? look(message, timeout) : std::unexpected(allowed.error());
}

Result<bool> Buffer::wait(Received &message, Timeout timeout) {
    const auto allowed = need_read();
    return allowed.has_value() ? take_next(message, timeout) : std::unexpected(allowed.error());
}

Result<> Buffer::clear(Timeout timeout) {
    const auto allowed = need_write();
    return allowed.has_value() ? empty(timeout) : allowed;
}

}  // namespace mw::nml
