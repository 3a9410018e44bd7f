"""pytest finds the plugin by itself."""

from importlib.metadata import distribution


def test_the_package_declares_its_plugin():
    [plugin] = distribution("uictest").entry_points.select(group="pytest11")
    assert plugin.load().__name__ == "uictest.api.pytest_plugin"
