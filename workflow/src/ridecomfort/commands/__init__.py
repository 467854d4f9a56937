"""Ride comfort on real roads, one piece at a time.

Each module here is a subcommand of its name: its docstring is the help,
``arguments(parser)`` adds its options and ``run(options)`` does the work.
"""
