// assets/bake/import/import_main.h
// bake import SURFACE ...: what `trocar import` runs. Called by bake's main.
#pragma once

namespace bake {

/// Exit 0: done; 2: bad usage, a bad file, or a surface that is refused, with file, place and
/// reason. On SIGINT, SIGTERM and SIGHUP it ends by that signal. In all cases but 0 nothing is
/// left behind.
int import_main(int argc, char** argv);

} // namespace bake
