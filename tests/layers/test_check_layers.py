"""check_layers.py finds each fault it is there for, and only that one."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import check_layers


class CheckLayers(unittest.TestCase):
    def found(self, path, text):
        """Faults of a clean tree with one file more."""
        with tempfile.TemporaryDirectory() as root:
            for name, content in (("src/base/vec.h", "#include <stdint.h>\n"),
                                  ("src/app/main.c", '#include "render/render.h"\n'), (path, text)):
                os.makedirs(os.path.dirname(os.path.join(root, name)) or root, exist_ok=True)
                with open(os.path.join(root, name), "w", encoding="utf-8") as file:
                    file.write(text if name == path else content)
            return check_layers.faults(root)

    def assert_one(self, path, text, part):
        found = self.found(path, text)
        self.assertEqual(len(found), 1, found)
        self.assertIn(part, found[0])

    def test_clean(self):
        for path, text in (
                ("src/render/render.c", '#include "gpu/device.h"\n#include <vulkan/vulkan.h>\n'),
                ("src/bvh/build.c", '#include "shaders/shared.h"\n#include "bvh/bvh.h"\n'),
                ("src/scene/nff.c", '#include "turner.h"\n#include "image/image.h"\n'),
                ("src/base/full.c", "int a;\n" * 800),
                ("tests/x/corpus/seed", "TO" "DO"),
                ("docs/x.md", "see https://example.org/home/page and lib/home/x")):
            self.assertEqual(self.found(path, text), [])

    def test_upwards(self):
        self.assert_one("src/image/a.c", '\n#include "scene/scene.h"\n', "src/image/a.c:2: ")
        self.assert_one("src/reference/a.c", '# include "gpu/device.h"\n', "below gpu")

    def test_shape(self):
        self.assert_one("src/gpu/a.c", '#include "device.h"\n', "layer/file.h")
        self.assert_one("src/gpu/a.c", '#include "../gpu/device.h"\n', "layer/file.h")
        self.assert_one("src/other/a.c", "\n", "not in the list")

    def test_shaders(self):
        self.assert_one("src/reference/a.c", '#include "shaders/shared.h"\n', "shaders")

    def test_vulkan(self):
        self.assert_one("src/bvh/a.h", "#include <vulkan/vulkan.h>\n", "Vulkan")
        self.assert_one("src/app/a.c", "#include <GLFW/glfw3.h>\n", "Vulkan")

    def test_length(self):
        self.assert_one("shaders/a.glsl", "\n" * 801, "801 lines")

    def test_words(self):
        for word in ("TO" "DO", "FIX" "ME", "X" "XX", "HA" "CK"):
            self.assert_one("docs/a.md", f"({word}: later)", "unfinished")
        self.assert_one("tools/a", "cd /ho" "me/me", "machine")
        self.assert_one("README.md", '"/wo' 'rk/x"', "machine")


if __name__ == "__main__":
    unittest.main()
