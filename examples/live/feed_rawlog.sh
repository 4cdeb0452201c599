#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Feeds an MRPT rawlog to `helixnav stream`: what the detector finds in its range scans, or its landmark observations.
#
#     examples/live/feed_rawlog.sh drive.rawlog [options of helixnav-rawlog] > answers.jsonl
set -eu
rawlog=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
helixnav-rawlog "$rawlog" "$folder/drive.jsonl" "$@" >&2  # and a vehicle.toml beside it
helixnav stream --vehicle "$folder/vehicle.toml" < "$folder/drive.jsonl"
