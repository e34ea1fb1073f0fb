// SPDX-License-Identifier: GPL-2.0-or-later
// The work of a server for one client, over any network.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "clients/nml/buffer/open.hh"
#include "clients/nml/message/codec.hh"
#include "clients/nml/net/jog_owners.hh"
#include "clients/nml/net/passwords.hh"
#include "clients/nml/net/protocol.hh"

namespace mw::nml {

/// The encoding of a buffer's messages, local or remote.
Encoding encoding_of(const BufferSettings &buffer);

struct ServedBuffer {
    BufferSettings buffer;
    ProcessSettings process;
    std::optional<Passwords> passwords;
};

/// Data shared by all sessions of a server, constant while they run.
struct Service {
    std::map<std::uint32_t, ServedBuffer> buffers;  ///< served buffers by number
    const Vocabulary &vocabulary;
    std::string instance;
    LocalPlaces &local;
    std::size_t longest = 0;  ///< message
    JogOwners *jogs = nullptr;
};

/// All calls come from one thread.
class Session {
  public:
    explicit Session(const Service &service) : service_(service) {}
    ~Session();
    Session(const Session &) = delete;
    Session &operator=(const Session &) = delete;

    /// Returns the answer to a request. A wait ends early when `isOver` returns true.
    Packet answer(const Packet &request, const std::function<bool()> &isOver);
    /// True after a wrong password: further requests are not read.
    bool isBarred() const { return barred_; }

  private:
    struct Open {
        const ServedBuffer *served = nullptr;
        std::unique_ptr<Buffer> buffer;
        bool logged_in = false;
    };
    Result<Open *> find(std::uint32_t number);
    Result<Packet> carry_out(const Packet &request, const std::function<bool()> &isOver);
    Result<Packet> log_in(const Packet &request, Open &open);
    Result<Packet> write(const Packet &request, Open &open);
    void note_jog(const Message &message);
    Result<Packet> read(const Packet &request, Open &open, const std::function<bool()> &isOver);

    const Service &service_;
    std::map<std::uint32_t, Open> open_;
    bool barred_ = false;
};

}  // namespace mw::nml
