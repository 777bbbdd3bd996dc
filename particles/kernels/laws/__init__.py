"""Contact laws: pure functions of numbers, chosen by the type of the law when a kernel is compiled.

Signs and sources: `particles.contact`.
"""
