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

/// Connections: a client has one for each buffer.
inline constexpr std::size_t MAX_SESSIONS = 128;

/// Every buffer of the configuration for which the process's line says server=1, at the ports of its B line,
/// at the address of its host there: "localhost" serves this computer alone. The buffers are opened by
/// then: a process that is their master keeps them open by separate connections. Ends its threads when it
/// is destroyed.
class Server {
  public:
    /// `vocabulary` and `local` must outlive it. An error when a port cannot be had.
    static Result<std::unique_ptr<Server>> start(const Config &config, const std::string &process,
                                                 const std::string &instance, const Vocabulary &vocabulary,
                                                 LocalPlaces &local);
    ~Server();

    /// Where it listens; of a port 0 in the configuration the one that it got. 0: it does not.
    int tcp_port() const;
    int udp_port() const;
    /// Stops of jogs whose connection has ended since the last call. What the connection has written before
    /// is in its buffer by then.
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
        std::list<Worker> workers;  ///< of this thread
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
