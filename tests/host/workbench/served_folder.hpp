// A folder with a shipped case as the working directory, and a workbench that serves it.
#pragma once

#include <gtest/gtest.h>
#include <httplib.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "host/workbench/server.hpp"
#include "tests/host/temporary_folder.hpp"

// A macro of <resolv.h>, which httplib.h includes. Eigen uses that name.
#undef _res

/// During its lifetime the working directory is a new folder.
class WorkingFolder {
 public:
  WorkingFolder() { std::filesystem::current_path(folder.path("")); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  ~WorkingFolder() { std::filesystem::current_path(before_); }

  /// model.toml and records of a shipped case, "single/case-00".
  void copy_case(const std::string& name) const {
    std::filesystem::copy(std::filesystem::path(AXIS_TEST_DATA) / "drive-cases" / name, folder.path(""));
  }

  const TemporaryFolder folder;

 private:
  const std::filesystem::path before_ = std::filesystem::current_path();
};

class ServedFolder : public WorkingFolder {
 public:
  explicit ServedFolder(const host::workbench::LiveDevice& device = {})
      : server(0, device), thread_([this] { server.run(); }) {
    const std::string url = server.url();
    token = url.substr(url.find("token=") + 6);
    own = {{"Cookie", "axistool-" + std::to_string(server.port()) + "=" + token}};
  }
  ~ServedFolder() { server.stop(); }

  httplib::Client client() const {
    httplib::Client client("127.0.0.1", server.port());
    client.set_read_timeout(120);
    return client;
  }

  /// A request of the workbench's page: the status, and the JSON of the reply.
  std::pair<int, nlohmann::json> get(const std::string& path) const { return told(client().Get(path, own)); }
  std::pair<int, nlohmann::json> post_text(const std::string& path, const std::string& body) const {
    return told(client().Post(path, own, body, "application/json"));
  }
  std::pair<int, nlohmann::json> post(const std::string& path, const nlohmann::json& body) const {
    return post_text(path, body.dump());
  }

  /// The job's state once it has ended.
  nlohmann::json ended(int id) const {
    for (int tries = 0; tries < 4000; ++tries) {
      nlohmann::json state = get("/api/jobs/" + std::to_string(id)).second;
      if (state["state"] != "queued" && state["state"] != "running") return state;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return nullptr;
  }

  host::workbench::Server server;
  std::string token;
  httplib::Headers own;

 private:
  static std::pair<int, nlohmann::json> told(const httplib::Result& result) {
    if (!result) return {0, nullptr};
    return {result->status, nlohmann::json::parse(result->body, nullptr, false)};
  }

  std::jthread thread_;
};
