// sim/command/commands.h
// One function per verb: declares its options and what to do. A command throws on bad input (exit
// 2) and sets `exit_code` to 1 for a rig fault or a failed expectation.
#pragma once

namespace CLI {
class App;
}

namespace sim {

void add_train(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_rescore(CLI::App& app, int& exit_code);
void add_trainee(CLI::App& app, int& exit_code);
void add_note(CLI::App& app, int& exit_code);
void add_scene(CLI::App& app, int& exit_code);
void add_study(CLI::App& app, int& exit_code);
void add_failures_study(CLI::App& study, int& exit_code); // a study
void add_scaling_study(CLI::App& study, int& exit_code);  // a study
void add_complexity_study(CLI::App& study);
void add_solid_studies(CLI::App& study, int& exit_code); // beam, block, cook
void add_solid_charts(CLI::App& study);                  // locking, large, tradeoff
void add_study_contact(CLI::App& study);                 // one of its charts, in a file of its own
void add_why_study(CLI::App& study);
void add_study_indenter(CLI::App& study);
void add_study_organ(CLI::App& study);
void add_import(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);
void add_devices(CLI::App& app, int& exit_code);

} // namespace sim
