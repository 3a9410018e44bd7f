"""Compiled templates, kept from one run to the next."""

from __future__ import annotations

from jinja2.bccache import Bucket, BytecodeCache, bc_magic

from uictest import user_cache


class TemplateCache(BytecodeCache):
    """Keeps compiled templates in the user's cache; one that is not there is compiled."""

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fill the bucket of a template if its code is there."""
        code = user_cache.read("template", _inputs(bucket))
        if code is not None:
            bucket.bytecode_from_string(code)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep the code of a template."""
        user_cache.write("template", _inputs(bucket), bucket.bytecode_to_string())


def _inputs(bucket: Bucket) -> bytes:
    return bc_magic + f"{bucket.key} {bucket.checksum}".encode()
