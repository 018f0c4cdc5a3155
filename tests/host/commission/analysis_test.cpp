// The parts of the records that a diagnosis uses.
#include <gtest/gtest.h>

#include "host/commission/steps.hpp"
#include "host/model/model_file.hpp"
#include "tests/host/commission/own_machine.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

/// Catches records that begin at rest: the initial state of a spring or a gap is unknown, so even the true model has an
/// error of several noise floors.
TEST(RecordsOfACommissioning, BeginInMotionForADiagnosis) {
  const TemporaryFolder folder;
  OwnBoard board;
  ASSERT_EQ(commission(board, folder.path("x"), "look", "validate").first, host::ExitCode::done);
  host::CommissionFolder kept(folder.path("x"));
  host::BoardClient client = board.client();
  host::CommissionSession session(client, own_options(), {}, kept);
  const host::Measurements measured =
      host::read_measurements(session, host::read_model(kept.require("model.toml", "friction")));
  EXPECT_EQ(measured.training_records().size(), host::kTrainingFiles.size());
  EXPECT_EQ(measured.validation_records().size(), host::kJudgingFiles.size());
  for (const auto& records : {measured.training_records(), measured.validation_records()})
    for (const host::Record* record : records) {
      EXPECT_GT(record->t_s.front(), 0.15) << record->path;
      EXPECT_NE(record->x.at(100), record->x.front()) << record->path;
    }
}

}  // namespace
