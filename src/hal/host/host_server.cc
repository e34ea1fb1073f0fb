// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/host/host_server.hh"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "hal/core/crash_report.hh"
#include "hal/core/host.hh"
#include "hal/host/controller_look.hh"
#include "hal/host/message.hh"
#include "hal/host/processes.hh"

namespace mw::hal {
namespace {

/// Interval of the search for processes with components. The kernel reports the end of processes that were
/// found.
constexpr int LOOK_MS = 50;
constexpr int ENDING_MS = 10;
constexpr std::int64_t LONGEST_BRAKING_NS = 10'000'000'000;

struct Client {
    int fd = -1;
    std::string buffer;
};

/// A process with components, and its pidfd.
struct Program {
    runtime::ProcessId process;
    int fd = -1;
};

int close_fd(int fd) {
    return fd >= 0 ? ::close(fd) : 0;
}

Message answer_of(const Result<> &result) {
    if (result) {
        return {"ok"};
    }
    return {"error", result.error().message, result.error().hint};
}

}  // namespace

struct HostServer::Impl {
    std::string instance;
    std::string path;
    int lock = -1, listener = -1, signals = -1;
    int controller = -1;  ///< pidfd of the controlling process
    ControllerLook controller_look;
    int controller_socket = -1;
    bool ending = false;
    std::int64_t gone_ns = 0;    ///< time when the controlling process died; 0 while it lives
    std::int64_t looked_ns = 0;  ///< time of the last search for programs
    std::vector<Client> clients;
    std::vector<Program> programs;
    std::unique_ptr<runtime::Log> log;
    std::unique_ptr<runtime::RealtimeScheduler> scheduler;
    std::unique_ptr<LocalHost> host;

    Result<> open(const HostServerOptions &options);
    Result<> take_lock();
    Result<> listen();
    void accept_client();
    bool isServed(Client &client);
    Message answer(const Client &client, const Message &request);
    Message take_control(const Client &client);
    static ucred peer_of(const Client &client);
    void end_for(const std::string &reason);
    void on_controller_gone();
    bool isControllerGone();
    void look_for_programs();
    void reap();
    void dismiss_programs() const;
    void serve(const std::vector<pollfd> &fds);
    bool isSafeToEnd();
    void take_safe_values();
    void drop(int fd);
    std::vector<pollfd> watched() const;
};

Result<> HostServer::Impl::take_lock() {
    const auto fd = hal::take_lock(instance);
    if (!fd) {
        return std::unexpected(fd.error());
    }
    lock = *fd;
    if (lock < 0) {
        return fail("a realtime process of instance '" + instance + "' is already running", {},
                    "end it with 'halrun -U', or choose another name in MILLWRIGHT_INSTANCE");
    }
    return {};
}

Result<> HostServer::Impl::listen() {
    const auto wanted = socket_path(instance);
    if (!wanted) {
        return std::unexpected(wanted.error());
    }
    path = *wanted;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) {
        return fail("the path of the socket is too long: " + path);
    }
    std::memcpy(address.sun_path, path.data(), path.size());
    // This process holds the lock, so an existing file belongs to a dead process.
    ::unlink(path.c_str());
    listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const bool is_bound =
        listener >= 0 &&
        ::bind(listener, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0 &&
        ::chmod(path.c_str(), 0600) == 0 && ::listen(listener, 16) == 0;
    return is_bound ? Result<>{} : fail("cannot listen at " + path + ": " + std::strerror(errno));
}

Result<> HostServer::Impl::open(const HostServerOptions &options) {
    instance = options.instance;
    controller = options.controller_fd;
    if (controller >= 0) {
        ::fcntl(controller, F_SETFD, FD_CLOEXEC);
    }
    if (auto taken = take_lock(); !taken) {
        return taken;
    }
    sigset_t mask;
    ::sigemptyset(&mask);
    ::sigaddset(&mask, SIGTERM);
    ::sigaddset(&mask, SIGINT);
    ::pthread_sigmask(SIG_BLOCK, &mask, nullptr);
    signals = ::signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
    log = std::make_unique<runtime::Log>(runtime::Log::Mode::DRAINED, options.sink, options.sink_context);
    scheduler = std::make_unique<runtime::RealtimeScheduler>(*log, options.realtime);
    InstanceOptions hal_options;
    hal_options.name = instance;
    hal_options.isShared = true;
    hal_options.scheduler = scheduler.get();
    hal_options.log = log.get();
    auto made = LocalHost::create(hal_options);
    if (!made) {
        return std::unexpected(made.error());
    }
    host = std::move(*made);
    host->hal().processes().spare(pid_of(controller));
    host->hal().host_status().set_realtime_missing(scheduler->missing());
    set_process_instance(&host->hal());
    auto listening = listen();
    if (listening) {
        const auto lock_file = lock_path(instance);
        report_crashes("millwright-rt",
                       {path, "/dev/shm/" + segment_name(instance), lock_file ? *lock_file : std::string()});
    }
    return listening;
}

void HostServer::Impl::accept_client() {
    const int fd = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    if (fd < 0) {
        return;
    }
    ucred peer{};
    socklen_t size = sizeof peer;
    if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0 || peer.uid != ::getuid()) {
        ::close(fd);
        return;
    }
    clients.push_back({fd, {}});
}

/// Reads the client's request and answers it; false when it has disconnected or sends invalid data.
bool HostServer::Impl::isServed(Client &client) {
    char bytes[4096];
    const ssize_t got = ::recv(client.fd, bytes, sizeof bytes, MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) {
        return true;
    }
    if (got <= 0) {
        return false;
    }
    client.buffer.append(bytes, static_cast<std::size_t>(got));
    Message request;
    while (true) {
        const auto whole = decode(client.buffer, request);
        if (!whole) {
            return false;
        }
        if (!*whole) {
            return true;
        }
        if (!isSent(client.fd, answer(client, request))) {
            return false;
        }
    }
}

ucred HostServer::Impl::peer_of(const Client &client) {
    ucred peer{};
    socklen_t size = sizeof peer;
    ::getsockopt(client.fd, SOL_SOCKET, SO_PEERCRED, &peer, &size);
    return peer;
}

/// Ends at once for the controlling process (no `reason`), which has stopped the machine; otherwise the
/// machine brakes first.
void HostServer::Impl::end_for(const std::string &reason) {
    if (reason.empty()) {
        ending = true;
        return;
    }
    host->hal().host_status().note_end(reason.c_str());
    if (host->hal().controller_watches().isEmpty()) {
        ending = true;
    } else {
        on_controller_gone();
    }
}

Message HostServer::Impl::take_control(const Client &client) {
    if (controller_socket >= 0 && controller_socket != client.fd) {
        return {"error", "another process controls the instance already", ""};
    }
    const ucred peer = peer_of(client);
    close_fd(controller);
    controller = static_cast<int>(::syscall(SYS_pidfd_open, peer.pid, 0));
    if (controller < 0) {
        return {"error", std::string("cannot watch the controlling process: ") + std::strerror(errno), ""};
    }
    controller_socket = client.fd;
    host->hal().processes().spare(peer.pid);
    return {"ok"};
}

Message HostServer::Impl::answer(const Client &client, const Message &request) {
    const std::string &what = request.empty() ? std::string() : request[0];
    const std::string name = request.size() > 1 ? request[1] : std::string();
    if (what == "load" && request.size() > 1) {
        Result<> loaded = host->load_realtime(name, {request.begin() + 2, request.end()});
        log->drain();
        return answer_of(loaded);
    }
    if (what == "unload") {
        Result<> unloaded = host->unload_realtime(name);
        log->drain();
        return answer_of(unloaded);
    }
    if (what == "modules") {
        Message message = {"ok"};
        for (const std::string &module : host->loader().modules()) {
            message.push_back(module);
        }
        return message;
    }
    if (what == "hello") {
        return {"ok", std::to_string(::getpid())};
    }
    if (what == "control") {
        return take_control(client);
    }
    if (what == "debug") {
        const auto level = static_cast<runtime::LogLevel>(std::atoi(name.c_str()));
        return answer_of(host->set_log_level(std::min(level, runtime::LogLevel::ALL)));
    }
    if (what == "end") {
        const bool by_controller = client.fd == controller_socket;
        end_for(by_controller ? "" : fmt::format("process {} requested its end", peer_of(client).pid));
        return {"ok"};
    }
    return {"error", "unknown request '" + what + "'", ""};
}

void HostServer::Impl::on_controller_gone() {
    close_fd(controller);
    controller = -1;
    controller_socket = -1;
    gone_ns = gone_ns == 0 ? host->now_ns() : gone_ns;
    host->hal().controller_watches().report_gone();
}

/// Opens a pidfd for every process with components, and closes others.
void HostServer::Impl::look_for_programs() {
    const std::vector<runtime::ProcessId> wanted = host->hal().processes().others();
    std::erase_if(programs, [&](const Program &program) {
        const bool gone = std::find(wanted.begin(), wanted.end(), program.process) == wanted.end();
        if (gone) {
            close_fd(program.fd);
        }
        return gone;
    });
    for (const runtime::ProcessId &process : wanted) {
        const bool known = std::any_of(programs.begin(), programs.end(),
                                       [&](const Program &program) { return program.process == process; });
        const int fd = known ? -1 : static_cast<int>(::syscall(SYS_pidfd_open, process.pid, 0));
        if (fd >= 0) {
            programs.push_back({process, fd});
        }
    }
    reap();
    host->hal().threads().publish_figures();
    looked_ns = host->now_ns();
}

/// Removes components of ended processes, and reports them.
void HostServer::Impl::reap() {
    const auto known = host->hal().processes().deaths();
    if (host->hal().processes().reap_dead().empty()) {
        return;
    }
    for (const DeathInfo &death : host->hal().processes().deaths()) {
        const bool is_new = std::none_of(known.begin(), known.end(), [&](const DeathInfo &earlier) {
            return earlier.name == death.name && earlier.time_ns == death.time_ns;
        });
        if (is_new) {
            log->print(
                runtime::LogLevel::ERR,
                "component '%s' died: its process %d ended without leaving HAL; its outputs have their safe "
                "values",
                death.name.c_str(), death.pid);
        }
    }
}

/// Requests processes with components to end, because the instance ends.
void HostServer::Impl::dismiss_programs() const {
    for (const Program &program : programs) {
        (void)::syscall(SYS_pidfd_send_signal, program.fd, SIGTERM, nullptr, 0);
    }
}

/// True when every watching module reports that the machine is stopped and off.
bool HostServer::Impl::isSafeToEnd() {
    return host->hal().controller_watches().isSafe() || !host->hal().threads().isRunning() ||
           host->now_ns() > gone_ns + LONGEST_BRAKING_NS;
}

/// Outputs of dead processes take their safe values, and the threads run long enough to pass them to the
/// hardware. This happens only after the machine has stopped, because an enable chain through the dead
/// process would interrupt the braking.
void HostServer::Impl::take_safe_values() {
    host->hal().processes().spare(0);
    reap();
    const timespec some_periods{0, 20'000'000};
    ::nanosleep(&some_periods, nullptr);
}

void HostServer::Impl::drop(int fd) {
    if (fd == controller_socket) {
        on_controller_gone();
    }
    ::close(fd);
    std::erase_if(clients, [fd](const Client &client) { return client.fd == fd; });
}

std::vector<pollfd> HostServer::Impl::watched() const {
    // poll ignores negative descriptors.
    std::vector<pollfd> fds = {{signals, POLLIN, 0}, {controller, POLLIN, 0}, {listener, POLLIN, 0}};
    for (const Client &client : clients) {
        fds.push_back({client.fd, POLLIN, 0});
    }
    // While the machine brakes nothing is reaped (see take_safe_values).
    for (const Program &program : programs) {
        fds.push_back({gone_ns == 0 ? program.fd : -1, POLLIN, 0});
    }
    return fds;
}

HostServer::HostServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<std::unique_ptr<HostServer>> HostServer::create(const HostServerOptions &options) {
    auto impl = std::make_unique<Impl>();
    auto opened = impl->open(options);
    auto server = std::unique_ptr<HostServer>(new HostServer(std::move(impl)));
    if (!opened) {
        return std::unexpected(opened.error());
    }
    return server;
}

HostServer::~HostServer() {
    if (impl_->host != nullptr) {
        set_process_instance(nullptr);
        impl_->host.reset();
    }
    impl_->scheduler.reset();
    if (!impl_->path.empty()) {
        ::unlink(impl_->path.c_str());
    }
    for (const Client &client : impl_->clients) {
        ::close(client.fd);
    }
    for (const Program &program : impl_->programs) {
        close_fd(program.fd);
    }
    for (const int fd : {impl_->controller, impl_->listener, impl_->signals}) {
        close_fd(fd);
    }
    if (impl_->lock >= 0) {
        drop_lock(impl_->instance, impl_->lock);
    }
}

/// Serves the clients with events in `watched`.
void HostServer::Impl::serve(const std::vector<pollfd> &fds) {
    // The controlling process is checked first, because its end is most urgent.
    if (fds[1].revents != 0) {
        on_controller_gone();
    }
    if (fds[0].revents != 0) {
        signalfd_siginfo signal{};
        (void)!::read(signals, &signal, sizeof signal);
        end_for(fmt::format("process {} ended it by signal {}", signal.ssi_pid, signal.ssi_signo));
    }
    if (fds[2].revents != 0) {
        accept_client();
    }
    bool died = false;
    for (std::size_t i = 3; i < fds.size(); ++i) {
        if (fds[i].revents == 0) {
            continue;
        }
        const auto client = std::find_if(clients.begin(), clients.end(),
                                         [&](const Client &one) { return one.fd == fds[i].fd; });
        died = died || client == clients.end();
        if (client != clients.end() && !isServed(*client)) {
            drop(fds[i].fd);
        }
    }
    if (died && !isControllerGone()) {
        look_for_programs();
    }
}

/// Checks again: a controlling process with components may have died between the checks of its two
/// descriptors.
bool HostServer::Impl::isControllerGone() {
    pollfd look{controller, POLLIN, 0};
    if (controller >= 0 && ::poll(&look, 1, 0) > 0) {
        on_controller_gone();
    }
    return gone_ns != 0;
}

void HostServer::run() {
    Impl &here = *impl_;
    while (!here.ending) {
        here.controller_look.step(here.host->hal(), here.gone_ns == 0 ? pid_of(here.controller) : 0);
        std::vector<pollfd> fds = here.watched();
        const bool braking = here.gone_ns != 0;
        const int ready = ::poll(fds.data(), fds.size(), braking ? ENDING_MS : LOOK_MS);
        if (ready < 0 && errno != EINTR) {
            break;
        }
        if (braking && here.isSafeToEnd()) {
            here.take_safe_values();
            here.look_for_programs();
            here.dismiss_programs();
            break;
        }
        if (!braking && here.host->now_ns() - here.looked_ns >= LOOK_MS * 1'000'000LL &&
            !here.isControllerGone()) {
            here.look_for_programs();
        }
        if (ready > 0) {
            here.serve(fds);
        }
    }
}

}  // namespace mw::hal
