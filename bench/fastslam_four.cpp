#include "fastslam_study.hpp"
namespace helixnav::bench { int run_four(const StudySettings&){return 0;} int run_robots(const StudySettings&){return 0;} int run_consistency(const StudySettings&){return 0;} }
