// SPDX-License-Identifier: GPL-2.0-or-later
// Serves the buffers of a process to other computers, over TCP, STCP and UDP (F6, F9).
#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "clients/nml/config/settings.hh"
#include "clients/nml/net/session.hh"
#include "clients/nml/net/socket.hh"

namespace mw::nml {

/// Maximum number of connections; a client has one for each buffer.
inline constexpr std::size_t MAX_SESSIONS = 128;

/// Serves each buffer of the configuration whose process line has server=1, at the ports of its B line and
/// the address of its host; "localhost" serves only this computer. The buffers must be open; if the process
/// is their master, separate connections keep them open. The destructor ends its threads.
class Server {
  public:
    /// `vocabulary` and `local` must outlive the server. An error if a port is not available.
    static Result<std::unique_ptr<Server>> start(const Config &config, const std::string &process,
                                                 const std::string &instance, const Vocabulary &vocabulary,
                                                 LocalPlaces &local);
    ~Server();

    /// The port at which it listens; for port 0 in the configuration the assigned port. 0: it does not
    /// listen.
    int tcp_port() const;
    int udp_port() const;
    /// Stops of jogs whose connection has ended since the last call. Data that the connection has written
    /// before are in the buffer.
    std::vector<messages::Command> take_left_jogs() { return jogs_.take(); }

  private:
    explicit Server(Service service) : service_(std::move(service)) { service_.jogs = &jogs_; }

    struct Worker {
        explicit Worker(Socket taken) : socket(std::move(taken)) {}
        Socket socket;
        std::atomic<bool> isDone{false};
        std::thread thread;
    };
    struct Listener {
        Socket socket;
        Transport transport = Transport::TCP;
        int port = 0;
        std::list<Worker> workers;  ///< used only by this thread
        std::thread thread;
    };

    Result<> listen(const std::string &host, int port, Transport transport);
    void accept(Listener &listener);
    void take_client(Listener &listener);
    void serve(Worker &worker);
    void serve_datagrams(Listener &listener);

    JogOwners jogs_;
    Service service_;
    std::atomic<bool> isEnding_{false};
    std::list<Listener> listeners_;
};

}  // namespace mw::nml
