# SPDX-License-Identifier: BSD-3-Clause
"""The include-graph check fails on each thing that it exists to refuse, and on nothing else."""
import shutil
import tempfile
import unittest
from pathlib import Path

import include_graph

ADR = Path(__file__).resolve().parents[2] / "docs/adr/0001-rooms.md"


class IncludeGraph(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "docs/adr").mkdir(parents=True)
        shutil.copy(ADR, self.root / "docs/adr")

    def findings(self, files):
        for name, text in files.items():
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return include_graph.check(self.root)

    def refused(self, name, text, words):
        findings = self.findings({name: text})
        self.assertEqual(len(findings), 1, findings)
        self.assertIn(words, findings[0])
        self.assertTrue(findings[0].startswith(name + ":"), findings[0])

    def test_accepts_what_the_table_allows(self):
        self.assertEqual([], self.findings({
            "core/include/helixnav/core/se2.hpp": "#pragma once\n#include <cmath>\n#include <Eigen/Core>\n",
            "core/src/recording.cpp": '#include "helixnav/core/recording.hpp"\n',
            "cekf/src/update.cpp": '#include <Eigen/Cholesky>\n#include "helixnav/core/se2.hpp"\n#include "blocks.hpp"\n',
            "cekf/src/blocks.hpp": "#pragma once\n",
            "cekf/src/deeper/a.cpp": '#include "blocks.hpp"\n',
            "apps/mrpt/slam/a.cpp": '#include "reading/b.hpp"\n',
            "apps/mrpt/reading/b.hpp": "#pragma once\n",
            "logs/src/reader.cpp": '#include <fstream>\n#include "helixnav/core/recording.hpp"\n',
            "apps/replay.cpp": '#include <iostream>\n#include "helixnav/cekf/cekf.hpp"\nvoid f() { std::cout << 1; }\n',
        }))

    def test_refuses_an_arrow_that_the_table_does_not_have(self):
        self.refused("cekf/src/a.cpp", '#include "helixnav/pf_relocalize/filter.hpp"\n', "cekf must not include pf_relocalize")

    def test_refuses_it_in_angle_brackets_too(self):
        self.refused("core/src/a.cpp", "#include <helixnav/sim/world.hpp>\n", "core must not include sim")

    def test_refuses_an_arrow_back_to_core_from_a_header(self):
        self.refused("core/include/helixnav/core/a.hpp", '#include "helixnav/logs/run.hpp"\n', "core must not include logs")

    def test_refuses_a_room_that_does_not_exist(self):
        self.refused("cekf/src/a.cpp", '#include "helixnav/attic/a.hpp"\n', "in no room")

    def test_refuses_truth_in_estimators(self):
        self.refused("supervisor/src/a.cpp", '#include "helixnav/core/recording.hpp"\n', "do not see truth")

    def test_refuses_files_and_screens_in_estimators(self):
        self.refused("cekf/src/a.cpp", "#include <fstream>\n", "no files and no screens")

    def test_refuses_mrpt_outside_the_adapter(self):
        self.refused("logs/src/a.cpp", "#include <mrpt/obs/CRawlog.h>\n", "MRPT")

    def test_refuses_third_parties_in_public_headers(self):
        self.refused("logs/include/helixnav/logs/a.hpp", "#include <nlohmann/json.hpp>\n", "public headers include Eigen")

    def test_refuses_relative_paths_out_of_the_room(self):
        self.refused("cekf/src/a.cpp", '#include "../../core/src/hidden.hpp"\n', "instead of")

    def test_refuses_quotes_around_what_is_not_ours(self):
        self.refused("logs/src/a.cpp", '#include "archive.h"\n', "no header of logs/src")

    def test_refuses_a_public_header_in_the_wrong_place(self):
        self.refused("cekf/include/helixnav/core/a.hpp", "#pragma once\n", "live in cekf/include/helixnav/cekf")

    def test_refuses_macros_in_public_headers(self):
        self.refused("core/include/helixnav/core/a.hpp", "#define PI 3\n", "no macros")

    def test_refuses_printing_and_asserting_in_libraries(self):
        self.refused("sim/src/a.cpp", "void f(int n) { assert(n > 0); }\n", "assert")

    def test_reads_neither_comments_nor_literals(self):
        self.assertEqual([], self.findings({
            "sim/src/a.cpp": '// assert(n)\n/* #include "helixnav/logs/a.hpp"\n#include "helixnav/logs/a.hpp"\n*/\n'
                             'const char* words = "std::cout exit(1)";\n'}))

    def test_refuses_a_table_with_a_cycle(self):
        (self.root / "docs/adr/0001-rooms.md").write_text("| core/ | x | cekf |\n| cekf/ | y | core |\n")
        with self.assertRaises(SystemExit):
            include_graph.check(self.root)


if __name__ == "__main__":
    unittest.main()
