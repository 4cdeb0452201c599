// SPDX-License-Identifier: BSD-3-Clause
#include "line_channel.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstring>

#include "common/interrupt.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::apps {
namespace {

[[noreturn]] void fail(const std::string& address, const std::string& why) {
  throw core::InputError("--listen " + address + ": " + why);
}

[[noreturn]] void fail_errno(const std::string& address) { fail(address, std::strerror(errno)); }

/// A socket that a process left behind when it was killed.
void remove_stale(const sockaddr_un& name, const std::string& address) {
  struct stat status {};
  if (::lstat(name.sun_path, &status) != 0) return;
  if (!S_ISSOCK(status.st_mode)) fail(address, "expected a path that is free, found a file there");
  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool alive = ::connect(probe, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0;
  ::close(probe);
  if (alive) fail(address, "another process listens there");
  ::unlink(name.sun_path);
}

int listen_unix(const std::string& path, const std::string& address) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof name.sun_path) fail(address, "expected a path of 1 to 107 bytes");
  std::copy(path.begin(), path.end(), name.sun_path);
  remove_stale(name, address);
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const mode_t mask = ::umask(0177);  // for this user alone
  const int bound = descriptor < 0 ? -1 : ::bind(descriptor, reinterpret_cast<const sockaddr*>(&name), sizeof name);
  ::umask(mask);
  if (bound != 0 || ::listen(descriptor, 1) != 0) fail_errno(address);
  return descriptor;
}

int listen_tcp(const std::string& word, std::string& address) {
  std::uint16_t port = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), port);
  if (error != std::errc{} || stop != word.data() + word.size()) fail(address, "expected a port from 0 to 65535");
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  name.sin_port = htons(port);
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  socklen_t size = sizeof name;
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&name), size) != 0 || ::listen(descriptor, 1) != 0 ||
      ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&name), &size) != 0) {
    fail_errno(address);
  }
  address = "tcp:" + std::to_string(ntohs(name.sin_port));
  return descriptor;
}

}  // namespace

LineChannel::LineChannel(const std::string& address) : address_(address) {
  std::signal(SIGPIPE, SIG_IGN);  // a closed peer shows in what write returns
  if (address.empty()) {
    in_ = STDIN_FILENO;
    out_ = STDOUT_FILENO;
  } else if (address.rfind("unix:", 0) == 0) {
    listening_ = listen_unix(address.substr(5), address);
    path_ = address.substr(5);
  } else if (address.rfind("tcp:", 0) == 0) {
    listening_ = listen_tcp(address.substr(4), address_);
  } else {
    fail(address, "expected unix:PATH or tcp:PORT");
  }
}

LineChannel::~LineChannel() {
  drop_client();
  if (listening_ >= 0) ::close(listening_);
  if (!path_.empty()) ::unlink(path_.c_str());
}

/// False if interrupted and nothing can be done at once. A signal may come just before poll sleeps, so it is checked
/// for often.
bool LineChannel::wait_for(int descriptor, short what) {
  constexpr int patience_ms = 100;
  pollfd polled{descriptor, what, 0};
  do {
    if (::poll(&polled, 1, patience_ms) > 0) return true;
  } while (!interrupted());
  return false;
}

bool LineChannel::accept_client() {
  for (;;) {
    if (!wait_for(listening_, POLLIN)) return false;
    const int client = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) continue;
    const int on = 1;
    ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);  // fails for a Unix socket, which needs none
    in_ = out_ = client;
    buffer_.clear();
    begin_ = searched_ = number_ = 0;
    skipping_ = ended_ = false;
    return true;
  }
}

void LineChannel::drop_client() {
  if (listening_ < 0 || in_ < 0) return;
  ::close(in_);
  in_ = out_ = -1;
}

void LineChannel::fill() {
  constexpr std::size_t block = 1 << 16;
  buffer_.erase(0, begin_);
  searched_ -= begin_;
  begin_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + block);
  const ssize_t got = ::read(in_, buffer_.data() + kept, block);
  buffer_.resize(kept + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (got == 0 || (got < 0 && errno != EINTR && errno != EAGAIN)) ended_ = true;
}

/// Off the buffer: a line, or the remainder at the end.
bool LineChannel::take_line(std::string& line) {
  const std::size_t end = buffer_.find('\n', searched_);
  const bool whole = end != std::string::npos;
  searched_ = whole ? end : buffer_.size();
  const std::size_t length = searched_ - begin_;
  const bool too_long = length > longest_line;
  if (!whole && !too_long && !(ended_ && length > 0)) return false;
  const bool was_skipping = skipping_;
  skipping_ = !whole && !ended_;
  line.assign(buffer_, begin_, std::min(length, longest_line + 1));
  begin_ = searched_ = whole ? end + 1 : searched_;
  if (was_skipping) return take_line(line);  // the rest of one already returned
  if (!line.empty() && line.back() == '\r') line.pop_back();
  ++number_;
  return true;
}

bool LineChannel::next(std::string& line) {
  while (!interrupted()) {
    if (in_ < 0 && !accept_client()) return false;
    if (take_line(line)) return true;
    if (ended_) {
      if (listening_ < 0) return false;
      drop_client();
      continue;
    }
    if (!wait_for(in_, POLLIN)) return false;
    fill();
  }
  return false;
}

std::string LineChannel::why_nobody_reads() const {
  if (write_error_ == EPIPE) return "the standard output is closed: nobody reads the answers";
  return std::string("the standard output cannot be written: ") + std::strerror(write_error_);
}

bool LineChannel::send(std::string line) {
  if (out_ < 0) return true;
  line += '\n';
  constexpr std::size_t chunk = 4096;  // poll guarantees this much for a pipe
  for (std::size_t sent = 0; sent < line.size();) {
    if (!wait_for(out_, POLLOUT)) return true;
    const ssize_t n = ::write(out_, line.data() + sent, std::min(chunk, line.size() - sent));
    if (n > 0) {
      sent += static_cast<std::size_t>(n);
    } else if (n < 0 && errno != EINTR && errno != EAGAIN) {
      write_error_ = errno;
      if (listening_ < 0) return false;
      out_ = -1;  // what it sent is still read
      return true;
    }
  }
  return true;
}

}  // namespace helixnav::apps
