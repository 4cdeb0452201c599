// SPDX-License-Identifier: BSD-3-Clause
#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "stream_lines.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

/// One end of a connection that answers.
class Talk {
 public:
  Talk(int in, int out) : in_(in), out_(out) {}
  ~Talk() { close(); }
  Talk(const Talk&) = delete;
  Talk& operator=(const Talk&) = delete;

  void say(const std::string& text) const {
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t n = ::write(out_, text.data() + sent, text.size() - sent);
      ASSERT_GT(n, 0);
      sent += static_cast<std::size_t>(n);
    }
  }
  /// The next line; null if none comes in time.
  Json hear() {
    constexpr int patience_ms = 30'000;
    for (;;) {
      const std::size_t end = heard_.find('\n');
      if (end != std::string::npos) {
        const Json line = Json::parse(heard_.substr(0, end));
        heard_.erase(0, end + 1);
        return line;
      }
      pollfd polled{in_, POLLIN, 0};
      char block[4096];
      const ssize_t n = ::poll(&polled, 1, patience_ms) == 1 ? ::read(in_, block, sizeof block) : 0;
      if (n <= 0) return {};
      heard_.append(block, static_cast<std::size_t>(n));
    }
  }
  void close() {
    if (in_ >= 0) ::close(in_);
    if (out_ >= 0 && out_ != in_) ::close(out_);
    in_ = out_ = -1;
  }
  void stop_saying() {
    ::close(out_);
    out_ = -1;
  }
  void stop_hearing() {
    ::close(in_);
    in_ = -1;
  }

 private:
  int in_, out_;
  std::string heard_;
};

class StreamProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    std::signal(SIGPIPE, SIG_IGN);
    ASSERT_EQ(run({"new-vehicle", log_}).exit_code, 0);
  }

  /// The answers to a file, and how the program ended.
  Outcome streamed(const Words& lines, const Words& more = {}) {
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    const fs::path file = folder_.write("lines.jsonl", text);
    Words words{"stream", "--vehicle", log_ / "vehicle.toml"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words, [&] { ::dup2(::open(file.c_str(), O_RDONLY), STDIN_FILENO); });
  }

  struct Talking {
    std::unique_ptr<Talk> talk;
    std::unique_ptr<Program> program;
  };
  /// With the program's standard streams.
  Talking begin(const Words& more = {}) {
    int to[2], from[2];
    if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    Words words{"stream", "--vehicle", log_ / "vehicle.toml"};
    words.insert(words.end(), more.begin(), more.end());
    Talking talking;
    talking.program = std::make_unique<Program>(words, [&] {
      ::dup2(to[0], STDIN_FILENO);
      ::dup2(from[1], STDOUT_FILENO);
    });
    ::close(to[0]);
    ::close(from[1]);
    talking.talk = std::make_unique<Talk>(from[0], to[1]);
    return talking;
  }

  static std::unique_ptr<Talk> connect_to(const fs::path& path) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    path.string().copy(name.sun_path, sizeof name.sun_path - 1);
    constexpr int patience_ms = 30'000;
    for (int ms = 0; ms < patience_ms; ++ms, ::usleep(1000)) {
      const int client = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
      if (::connect(client, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0)
        return std::make_unique<Talk>(client, client);
      ::close(client);
    }
    throw std::runtime_error("nobody listens");
  }

  static Words answers_of(const std::string& out, const std::string& kind) {
    Words found;
    std::istringstream lines(out);
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("{\"" + kind + "\":", 0) == 0) found.push_back(line);
    }
    return found;
  }

  testing::TemporaryFolder folder_;
  const fs::path log_ = folder_.path() / "robot";
  const fs::path out_ = folder_.path() / "run";
  static std::string odometry(double t_s) {
    return "{\"odometry\": {\"t\": " + std::to_string(t_s) + ", \"dx\": 0.1, \"dheading\": 0}}\n";
  }
  static std::string scan(double t_s) {
    return "{\"detections\": [{\"t\": " + std::to_string(t_s) + ", \"range\": 5, \"bearing\": 0.1}]}\n";
  }
};

TEST_F(StreamProgram, NavigatesAsReplayOfTheSameLogToTheLastDigit) {
  const Words lines = lines_of(log_, 60.0);
  const Outcome live = streamed(lines, {"--out", out_});
  ASSERT_EQ(live.exit_code, 0) << live.err;
  const fs::path of_replay = folder_.path() / "replayed";
  const Outcome replayed = run(
      {"replay", folder_.path() / "lines.jsonl", "--vehicle", log_ / "vehicle.toml", "--out", of_replay, "--quiet"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  for (const char* name : {"trajectory.tum", "map.csv", "map.bin", "associations.csv", "decisions.csv", "merges.csv"}) {
    EXPECT_EQ(text_of(out_ / name), text_of(of_replay / name)) << name;
  }
  EXPECT_EQ(names_in(out_), names_in(of_replay));
  const Words scans = answers_of(live.out, "scan");
  ASSERT_EQ(scans.size(), complete_lines(out_ / "health.csv") - 1);
  ASSERT_GT(scans.size(), 50u);
  const Json last = Json::parse(scans.back())["scan"];
  const auto summary = Json::parse(text_of(out_ / "summary.json"));
  EXPECT_EQ(summary["steps"], scans.size());
  EXPECT_EQ(last["step"], scans.size() - 1);
  EXPECT_EQ(last["mode"], "mapping");
  EXPECT_FALSE(last["associations"].empty());
  EXPECT_EQ(last["associations"][0]["outcome"], "matched");
  // The last row of the health table holds the covariance, number by number.
  const std::string health = text_of(out_ / "health.csv");
  const Words cells = columns_of(health.substr(health.rfind('\n', health.size() - 2) + 1));
  EXPECT_EQ(last["covariance"][1][1].get<double>(), std::stod(cells.at(6))) << "syy of its row";
  EXPECT_EQ(last["numerics"]["least_pivot"].get<double>(), std::stod(cells.at(18)));
  EXPECT_EQ(last["numerics"]["refused"], 0);
}

TEST_F(StreamProgram, RefusesALineWithItsNumberAndKeyAndGoesOn) {
  const Outcome outcome = streamed({odometry(0.0), "{\"odometry\": {\"t\": 0.5, \"dx\"", odometry(1.0),
                                    "{\"odometry\": {\"t\": 1.5, \"dx\": \"nan\", \"dheading\": 0}}", odometry(0.5),
                                    scan(0.5), scan(0.25), "{\"odometry\": {\"t\": 2}} trailing"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Words refused = answers_of(outcome.out, "refused");
  // The test's line ends with a newline, so that an empty line follows.
  const std::vector<std::pair<int, Json>> expected{{3, nullptr}, {6, "dx"}, {7, "t"}, {11, "t"}, {13, nullptr}};
  ASSERT_EQ(refused.size(), expected.size()) << outcome.out;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Json answer = Json::parse(refused[i])["refused"];
    EXPECT_EQ(answer["line"], expected[i].first) << refused[i];
    EXPECT_EQ(answer["key"], expected[i].second) << refused[i];
  }
  EXPECT_EQ(answers_of(outcome.out, "scan").size(), 1u);
  EXPECT_EQ(Json::parse(answers_of(outcome.out, "end").at(0))["end"],
            (Json{{"why", "end of input"}, {"scans", 1}, {"refused", 5}}));
}

TEST_F(StreamProgram, AnswersEachScanAtOnceAndWaitsForTheRestOfALine) {
  Talking live = begin();
  live.talk->say(odometry(0.0) + odometry(1.0) + scan(0.5));
  EXPECT_EQ(live.talk->hear()["scan"]["t"], 0.5);
  const std::string line = scan(0.75);
  live.talk->say(line.substr(0, 10));
  ::usleep(20'000);
  live.talk->say(line.substr(10));
  EXPECT_EQ(live.talk->hear()["scan"]["t"], 0.75);
  live.talk->say("{\"detections\": [{\"t\": 1.0}]}");  // without a newline
  live.talk->stop_saying();
  EXPECT_EQ(live.talk->hear()["scan"]["t"], 1.0);
  EXPECT_EQ(live.talk->hear()["end"]["why"], "end of input");
  EXPECT_EQ(live.program->wait().exit_code, 0);
}

TEST_F(StreamProgram, EndsInOrderOnSigterm) {
  Talking live = begin({"--out", out_});
  live.talk->say(odometry(0.0) + odometry(1.0) + scan(0.5));
  EXPECT_EQ(live.talk->hear()["scan"]["step"], 0);
  live.program->send(SIGTERM);
  EXPECT_EQ(live.talk->hear()["end"], (Json{{"why", "signal"}, {"scans", 1}, {"refused", 0}}));
  EXPECT_EQ(live.program->wait().exit_code, 130);
  EXPECT_TRUE(fs::exists(out_ / "summary.json"));
  EXPECT_EQ(complete_lines(out_ / "trajectory.tum"), 2u);
}

TEST_F(StreamProgram, IsJudgedByTheTruthOfItsLog) {
  ASSERT_EQ(streamed(lines_of(log_, 60.0), {"--out", out_}).exit_code, 0);
  const Outcome judged = run({"evaluate", out_, "--truth", log_, "--json"});
  ASSERT_EQ(judged.exit_code, 0) << judged.err;
  const Json figures = Json::parse(judged.out);
  EXPECT_LT(figures["error"]["rmse_m"].get<double>(), 1.0) << "in the map frame as it is";
  EXPECT_TRUE(figures.contains("nees")) << judged.out;
}

TEST_F(StreamProgram, LeavesAFolderThatIsReadWhenItIsKilled) {
  Talking live = begin({"--out", out_});
  live.talk->say(odometry(0.0) + odometry(1.0) + scan(0.5));
  live.talk->hear();
  live.program->send(SIGKILL);
  live.program->wait();
  const Outcome evaluation = run({"evaluate", out_, "--json"});
  ASSERT_EQ(evaluation.exit_code, 0) << evaluation.err;
  EXPECT_EQ(Json::parse(evaluation.out)["steps"], 1);
}

std::string lengths_in_force(const fs::path& folder) {
  const std::string config = Json::parse(text_of(folder / "manifest.json"))["config"];
  return config.substr(config.find("# Field of view"));
}

/// Its client resends what it has of the last seconds, at least the row before the last scan.
TEST_F(StreamProgram, GoesOnWhereItWasKilledAsIfNothingHadHappened) {
  const Words lines = lines_of(log_, 60.0);
  const Outcome whole = streamed(lines, {"--out", out_});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const Words answers = answers_of(whole.out, "scan");
  const fs::path killed = folder_.path() / "killed";
  const fs::path again = folder_.path() / "again";
  const std::size_t cut = lines.size() / 2;
  Talking live = begin({"--out", killed});
  for (std::size_t i = 0; i < cut; ++i) live.talk->say(lines[i] + '\n');
  std::size_t heard = 0;
  while (heard < answers.size() / 3 && !live.talk->hear().is_null()) ++heard;
  live.program->send(SIGKILL);
  live.program->wait();
  const Outcome rest = streamed(Words(lines.begin() + static_cast<std::ptrdiff_t>(cut / 3), lines.end()),
                                {"--resume", killed, "--out", again});
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  const Words more = answers_of(rest.out, "scan");
  ASSERT_FALSE(answers_of(rest.out, "note").empty()) << "says how much was driven again";
  ASSERT_LE(more.size(), answers.size() - heard) << "what was driven before is not answered again";
  const auto without_line = [](const std::string& answer) {
    Json scan = Json::parse(answer)["scan"];
    scan.erase("line");
    return scan;
  };
  for (std::size_t i = 0; i < more.size(); ++i) {
    EXPECT_EQ(without_line(more[i]), without_line(answers[answers.size() - more.size() + i]));
  }
  for (const char* name : {"trajectory.tum", "map.csv", "map.bin", "associations.csv", "decisions.csv", "drive.bin"}) {
    EXPECT_EQ(text_of(out_ / name), text_of(again / name)) << name;
  }
  EXPECT_EQ(lengths_in_force(out_), lengths_in_force(again));
  const std::string kept = text_of(killed / "drive.bin");
  const Outcome over = streamed({}, {"--resume", killed, "--out", killed, "--overwrite"});
  EXPECT_EQ(over.exit_code, 3);
  EXPECT_NE(over.err.find("another folder"), std::string::npos) << over.err;
  EXPECT_EQ(text_of(killed / "drive.bin"), kept);
}

/// The last scan was answered with odometry that ended before it; that odometry continues in what the client resends.
TEST_F(StreamProgram, GoesOnFromAnInputThatEndedAsIfItHadNot) {
  const Words lines = lines_of(log_, 30.0);
  ASSERT_EQ(streamed(lines, {"--out", out_}).exit_code, 0);
  const fs::path ended = folder_.path() / "ended", again = folder_.path() / "again", same = folder_.path() / "same";
  std::size_t cut = lines.size() / 2;
  while (lines[cut - 1].find("range_m") == std::string::npos) ++cut;
  Words part(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(cut));
  part.erase(part.end() - 2);  // odometry
  ASSERT_EQ(streamed(part, {"--out", ended}).exit_code, 0);
  ASSERT_EQ(streamed(lines, {"--resume", ended, "--out", again}).exit_code, 0);
  ASSERT_EQ(streamed({}, {"--resume", ended, "--out", same}).exit_code, 0);
  for (const char* name : {"trajectory.tum", "map.csv", "map.bin", "associations.csv", "decisions.csv", "drive.bin"}) {
    EXPECT_EQ(text_of(out_ / name), text_of(again / name)) << name;
    EXPECT_EQ(text_of(ended / name), text_of(same / name)) << name << ", nothing having come";
  }
}

TEST_F(StreamProgram, EndsInOrderWhenNobodyReadsItsAnswers) {
  Talking live = begin({"--out", out_});
  live.talk->stop_hearing();
  live.talk->say(odometry(0.0) + odometry(1.0) + scan(0.5));
  const Outcome outcome = live.program->wait();
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("standard output is closed"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(out_ / "summary.json"));
}

TEST_F(StreamProgram, WaitsForWhoeverReadsSlowly) {
  Talking live = begin();
  std::string lines = odometry(0.0) + odometry(1e3);
  for (int i = 1; i <= 500; ++i) lines += scan(i);
  live.talk->say(lines);  // a pipe holds 64 KiB, fewer answers than these
  ::usleep(50'000);
  for (int i = 1; i <= 500; ++i) ASSERT_EQ(live.talk->hear()["scan"]["t"], i);
}

TEST_F(StreamProgram, ServesOneClientAfterAnotherOnASocketAndKeepsItsMap) {
  const fs::path socket = folder_.path() / "socket";
  Program program({"stream", "--vehicle", log_ / "vehicle.toml", "--listen", "unix:" + socket.string(), "--out", out_});
  auto first = connect_to(socket);
  first->say(odometry(0.0) + odometry(1.0) + scan(0.5) + "{\"odometry\": {\"t\": 1.5, ");
  EXPECT_EQ(first->hear()["scan"]["step"], 0);
  first->close();  // in the middle of a line
  const auto second = connect_to(socket);
  second->say("nonsense\n" + odometry(2.0) + scan(1.75));
  EXPECT_EQ(second->hear()["refused"]["line"], 1) << "lines count from 1 for each client";
  EXPECT_EQ(second->hear()["scan"]["step"], 1);
  program.send(SIGINT);
  EXPECT_EQ(second->hear()["end"], (Json{{"why", "signal"}, {"scans", 2}, {"refused", 2}}));
  EXPECT_EQ(program.wait().exit_code, 130);
  EXPECT_FALSE(fs::exists(socket));
  EXPECT_EQ(complete_lines(out_ / "health.csv"), 3u);
}

TEST_F(StreamProgram, ListensOnLoopbackOnlyAndSaysWhatIsWrongWithAnAddress) {
  const auto expect = [&](const std::string& address, const std::string& words) {
    const Outcome outcome = run({"stream", "--vehicle", log_ / "vehicle.toml", "--listen", address});
    EXPECT_EQ(outcome.exit_code, 3) << address;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  expect("tcp:70000", "expected a port");
  expect("tcp:0.0.0.0:80", "expected a port");
  expect("udp:1", "expected unix:PATH or tcp:PORT");
  expect("unix:" + (log_ / "vehicle.toml").string(), "found a file there");
  expect("unix:" + std::string(200, 'x'), "107 bytes");
  EXPECT_EQ(run({"stream"}).exit_code, 2);
  EXPECT_EQ(run({"stream", "--vehicle", "no.toml"}).exit_code, 3);
  EXPECT_EQ(streamed({}, {"--out", log_}).exit_code, 3) << "the folder is taken";
}

TEST_F(StreamProgram, AnswersOnATcpSocketOfThisMachine) {
  const fs::path said = folder_.path() / "said";
  Program program({"stream", "--vehicle", log_ / "vehicle.toml", "--listen", "tcp:0"},
                  [&] { ::dup2(::open(said.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO); });
  for (int ms = 0; ms < 30'000 && complete_lines(said) == 0; ++ms) ::usleep(1000);
  const std::string text = text_of(said);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  name.sin_port = htons(static_cast<std::uint16_t>(std::stoi(text.substr(text.rfind(':') + 1))));
  const int client = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(::connect(client, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  Talk talk(client, client);
  talk.say(odometry(0.0) + odometry(1.0) + scan(0.5));
  EXPECT_EQ(talk.hear()["scan"]["step"], 0);
}

}  // namespace
}  // namespace helixnav::apps
