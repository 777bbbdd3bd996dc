"""`python -m coupled.cli`."""

from coupled.cli.app import main

if __name__ == "__main__":
    main()
