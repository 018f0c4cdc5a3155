// The page's commissioning: that of the command, within the page's command of the axes.
#include "host/cancellation.hpp"
#include "host/commission/commission.hpp"
#include "host/commission/start.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/open_board.hpp"
#include "host/workbench/live.hpp"

namespace host::workbench {

namespace {

/// Set during its lifetime. Throws Failure(refused) if it is set already.
class Only {
 public:
  explicit Only(std::atomic<bool>& flag) : flag_(flag) {
    if (flag_.exchange(true)) throw Failure(ExitCode::refused, "another commissioning has not ended: cancel it first");
  }
  Only(const Only&) = delete;
  Only& operator=(const Only&) = delete;
  ~Only() { flag_ = false; }

 private:
  std::atomic<bool>& flag_;
};

/// The board records for the commissioning alone during its lifetime.
class Lent {
 public:
  explicit Lent(BoardWatch& watch) : watch_(watch) {
    watch_.lend("A commissioning records: no channels are shown until it ends.");
  }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;
  ~Lent() {
    watch_.give_back();
    watch_.look_again();
  }

 private:
  BoardWatch& watch_;
};

}  // namespace

nlohmann::json Live::commission(const Request& request, const std::function<void(double, const std::string&)>& tell) {
  const CommissionRequest& wish = request.commission.value();
  require_command(wish.owner);
  const Only only(is_commissioning_);
  const CommissionStart start = start_commission({.axis = wish.axis,
                                                  .folder = wish.folder,
                                                  .sheet = read_drive(folder_.existing(request.models.front())),
                                                  .box = wish.box,
                                                  .overtravel = wish.overtravel(),
                                                  .force_N = {},
                                                  .continues = !wish.from.empty()});
  BoardClient board = open_board(device_.device, std::chrono::duration<double>(device_.patience_s));
  axis_index(wish.axis, board.axis_count());
  const Lent lent(watch_);
  board.take_over();  // from this page's other connection
  CommissionTalk talk;
  talk.consents = [&](const std::string&) {
    require_command(wish.owner);
    return true;
  };
  talk.stop = [&] { return is_cancelled() || !ownership_.holds(wish.owner, Clock::now()); };
  talk.tell = [&](const std::string& text) {
    const std::size_t done = start.folder->first_undone().value_or(kCommissionSteps.size());
    tell(static_cast<double>(done) / static_cast<double>(kCommissionSteps.size()), text);
    watch_.look_again();  // a step may have changed the parameters
  };
  const std::size_t from = wish.from.empty() ? 0 : commission_step(wish.from);
  const std::size_t to = wish.to.empty() ? kCommissionSteps.size() - 1 : commission_step(wish.to);
  commission_axis(board, start.options, talk, *start.folder, from, to);
  return start.folder->document();
}

}  // namespace host::workbench
