(* touchstone-check-verified: the checker whose mathematics is proved (Proof.v), with the arguments,
   the output and the exit status of touchstone-check. *)

open Certificate

let usage =
  "usage: touchstone-check-verified [OPTIONS] FILE|- [SCENES]\n\n\
   Checks the certificates of queries and of steps in a file, or on standard input for '-': each is\n\
   accepted only if it proves its claim, by a checker that is itself proved. The format:\n\
   exact/CERTIFICATES.md; what has to be believed: docs/trust.md.\n\
   SCENES: the certificates are of steps, and of these scenes.\n\n\
   --claim CLAIM     Reject whatever claims anything else: no_collision, collision,\n\
  \                  'time_of_impact [LO HI]', no_inversion, inversion, 'time_of_inversion [LO HI]';\n\
  \                  of steps free, 'no_contact T', 'earliest [LO HI]', or sequence: free, and each\n\
  \                  begins where the last one ended\n\
   --rules RULES     Reject whatever has other rules, which weaken a claim, than these, in the words\n\
  \                  of the report: '1 pair of groups held apart'. Without it and without SCENES\n\
  \                  free and sequence reject all rules\n\
   --separation D    Reject whatever is about another distance (0: contact itself)\n\
   --norm NORM       The norm of --separation: l2 (the default) or linf\n\n\
   Exit status: 0 all accepted and the stream complete, 1 one rejected or the stream cut, 2\n\
   unreadable input, unwritable output, wrong usage, or what is not covered: meshes, and thickness\n\
   of more than 200 groups or of one above 1000.\n\n\
   Example: zstdcat proofs.cert.zst | touchstone-check-verified -\n\
  \         touchstone-check-verified --claim free --separation 0 step.cert scenes.txt\n"

type options = { claim : string; separation : string; rules : string; has_scenes : bool }

type report = {
  accepted : int array;  (* by claim: of collisions, then of inversions *)
  mutable steps : string list;  (* what the accepted ones prove, the last first *)
  mutable summary : string;  (* what all of these prove together; empty if one is rejected *)
  mutable rejected : int;
  mutable rejections : (int * string * string) list;  (* the first ones: line, label, reason *)
}

let max_rejections = 100

let note_rejection report r label line reason =
  report.rejected <- report.rejected + 1;
  if report.rejected <= max_rejections then
    let line = if line <> 0 then line else r.number in
    report.rejections <- report.rejections @ [ (line, printable label, reason) ]

let is_demanded demand text = demand = "" || text = demand || starts_with (demand ^ " ") text

let require_demanded options line claim separation rules =
  let is_free = options.claim = "free" || options.claim = "sequence" in
  if not (is_demanded (if is_free then "no_contact 1" else options.claim) claim) then
    reject ~line ("the claim is not the one demanded: " ^ claim);
  (* Where the norm does not matter it is not named. *)
  let is_separation =
    options.separation = "" || options.separation = separation
    || starts_with (separation ^ " ") options.separation
  in
  if not is_separation then reject ~line ("the separation is not the one demanded: " ^ separation);
  let are_rules =
    if options.rules = "" then (not is_free) || options.has_scenes || rules = "" else options.rules = rules
  in
  if not are_rules then
    reject ~line ("the rules are not those demanded: " ^ if rules = "" then "none" else rules)

(* Checks the certificate that begins at the present line, and goes to where the next may begin. *)
let check_one report options r =
  let first = r.number in
  let label = ref "" in
  let is_read = ref false in
  (try
     let c = read_certificate r (fun text -> label := text) in
     is_read := true;
     require_demanded options c.claim_line (text_of_claim c.is_tetrahedron c.claim)
       (text_of_separation (of_coq c.separation.distance_of) c.separation.norm_of) "";
     require_small_numbers c;
     if not (Elaborate.check c) then begin
       let line, reason = Elaborate.fault c in
       reject ~line reason
     end;
     let claim =
       match c.claim with Checker.No_collision -> 0 | Checker.Collision -> 1 | Checker.Time_of_impact _ -> 2
     in
     let place = if c.is_tetrahedron then 3 + claim else claim in
     report.accepted.(place) <- report.accepted.(place) + 1
   with Rejection (line, reason) -> note_rejection report r !label line reason);
  let may_begin () = first_word r = "query" || first_word r = "certificates" in
  if not !is_read then
    while (not r.at_end) && (r.number = first || not (may_begin ())) do advance r done

let check_end options r scenes word certificates =
  let expected = word ^ " " ^ string_of_int certificates in
  if r.at_end then reject ("the stream is cut: it has no closing line '" ^ expected ^ "'");
  let is_demanded = options.claim ^ options.separation ^ options.rules <> "" || scenes <> None in
  if certificates = 0 && is_demanded then
    reject "there is no certificate of what is demanded";
  begin_keyword r word;
  if r.text <> expected then
    reject (Printf.sprintf "expected the closing line '%s', found %s" expected (quoted r.text));
  advance r;
  if not r.at_end then reject "a line after the closing line"

let check_queries report options r =
  let queries = ref 0 in
  while (not r.at_end) && first_word r <> "certificates" do
    if first_word r = "query" then incr queries;
    check_one report options r
  done;
  check_end options r None "certificates" !queries

(* What all steps prove together, in the words of ../summary.cpp. *)
type summary = {
  count : int;
  first_gap : int;  (* the first step that does not follow, or 0 *)
  gaps : int;
  last : Step_certificate.proved option;  (* the last one, with what is common to all *)
}

let with_step (summary : summary) (proved : Step_certificate.proved) follows =
  let count = summary.count + 1 in
  match summary.last with
  | None -> { summary with count; last = Some proved }
  | Some last ->
      let gaps = if follows then summary.gaps else summary.gaps + 1 in
      let first_gap = if gaps = 1 && not follows then count else summary.first_gap in
      let is_free = last.is_free && proved.is_free in
      (* Whatever is not within a distance does not touch. *)
      let contact = if last.contact = proved.contact then last.contact else "touch" in
      let rules = if last.rules = proved.rules then last.rules else "the rules differ" in
      { count; first_gap; gaps; last = Some { proved with is_free; contact; rules } }

let gaps_text { first_gap; gaps; _ } =
  if gaps = 0 then ""
  else
    Printf.sprintf "; step %d does not begin where step %d ended" first_gap (first_gap - 1)
    ^ if gaps = 1 then ""
      else (if gaps = 2 then ", nor does " else ", nor do ") ^ Step_certificate.counted (gaps - 1) "other" "others"

let summary_text summary =
  match summary.last with
  | None -> ""
  | Some { is_free = false; _ } when summary.count = 1 -> ""
  | Some { is_free; contact; rules; _ } ->
      let order =
        if summary.count = 1 then ""
        else if summary.gaps = 0 then ", each from where the last one ended"
        else ", each by itself"
      in
      let claim =
        if not is_free then ""
        else if rules = "" then ": no two primitives " ^ contact
        else Printf.sprintf ": no two primitives that can collide %s; %s" contact rules
      in
      Step_certificate.counted summary.count "step" "steps" ^ order ^ claim ^ gaps_text summary

(* Checks the certificates of steps to the first that is rejected. *)
let check_steps report options r scenes =
  Option.iter advance scenes;
  let summary = ref { count = 0; first_gap = 0; gaps = 0; last = None } in
  while first_word r = "step" do
    let line = r.number in
    let proved = Step_certificate.check r scenes (require_demanded options) in
    let follows =
      match !summary.last with
      | None -> true
      | Some last -> Checker.seems_followed_by last.scene proved.scene
    in
    if (not follows) && options.claim = "sequence" then
      reject ~line "the step does not begin where the last one ended";
    report.steps <- proved.text :: report.steps;
    summary := with_step !summary proved follows
  done;
  check_end options r scenes "steps" (List.length report.steps);
  Option.iter (fun scenes -> if not scenes.at_end then reject "not all scenes are proved") scenes;
  report.summary <- summary_text !summary

let check options channel scenes =
  let report =
    { accepted = Array.make 6 0; steps = []; summary = ""; rejected = 0; rejections = [] }
  in
  let r = reader_of channel in
  let header = "touchstone-certificates 2" in
  let steps_header = "touchstone-steps 2" in
  let meshes_header = "touchstone-meshes 1" in
  (try
     advance r;
     let first = r.text in
     if first = meshes_header then raise (Step_certificate.Not_covered "certificates of meshes");
     if first = steps_header then begin
       advance r;
       check_steps report options r (Option.map reader_of scenes)
     end
     else if scenes <> None then
       reject ~line:1
         (Printf.sprintf "the first line is not '%s' or '%s', as for scenes" steps_header meshes_header)
     else if first <> header then reject ~line:1 ("the first line is not '" ^ header ^ "'")
     else begin
       advance r;
       check_queries report options r
     end
   with Rejection (line, reason) -> note_rejection report r "" line reason);
  report

let print report =
  let n = report.accepted in
  Printf.printf "accepted         %d\n  no_collision   %d\n  collision      %d\n  time_of_impact %d\n"
    (Array.fold_left ( + ) (List.length report.steps) n) n.(0) n.(1) n.(2);
  if n.(3) + n.(4) + n.(5) > 0 then
    Printf.printf "  no_inversion      %d\n  inversion         %d\n  time_of_inversion %d\n" n.(3) n.(4) n.(5);
  Printf.printf "rejected         %d\n" report.rejected;
  List.iter print_string (List.rev report.steps);
  let print_rejection (line, label, reason) =
    let name = if label = "" then "" else " (" ^ label ^ ")" in
    Printf.printf "  line %d%s: %s\n" line name reason
  in
  List.iter print_rejection report.rejections;
  let hidden = report.rejected - List.length report.rejections in
  if hidden > 0 then Printf.printf "  and %d more\n" hidden;
  if report.summary <> "" then print_endline report.summary

type arguments = Help | Wrong | Check of string list * options

let rec parsed words files options norm =
  match words with
  | [] -> (
      match files with
      | [] | "" :: _ | _ :: _ :: _ :: _ | [ _; ("-" | "") ] -> Wrong
      | _ when options.separation = "" && norm <> "" -> Wrong
      | _ ->
          let norm = if norm = "" then "l2" else norm in
          let separation =
            if options.separation = "" then "" else demanded_separation options.separation norm
          in
          Check (files, { options with separation; has_scenes = List.length files = 2 }))
  | "--help" :: _ -> Help
  | word :: rest when word = "-" || not (starts_with "-" word) ->
      parsed rest (files @ [ word ]) options norm
  | _ :: ([] | "" :: _) -> Wrong
  | "--claim" :: value :: rest -> parsed rest files { options with claim = demanded_claim value } norm
  | "--rules" :: value :: rest -> parsed rest files { options with rules = value } norm
  | "--separation" :: value :: rest -> parsed rest files { options with separation = value } norm
  | "--norm" :: value :: rest -> parsed rest files options value
  | _ -> Wrong

let fail message = prerr_string ("touchstone-check-verified: " ^ message ^ "\n"); 2

let check_file path scenes options =
  let opened path =
    let channel =
      if path = "-" then stdin
      else try open_in_bin path with Sys_error _ -> failwith "the file cannot be opened"
    in
    set_binary_mode_in channel true;
    channel
  in
  let channel = opened path in
  let report =
    try check options channel (Option.map opened scenes)
    with Sys_error _ -> failwith "the stream cannot be read"
  in
  print report;
  if report.rejected = 0 then 0 else 1

let run () =
  let options = { claim = ""; separation = ""; rules = ""; has_scenes = false } in
  match parsed (List.tl (Array.to_list Sys.argv)) [] options "" with
  | Help -> print_string usage; 0
  | Wrong -> prerr_string usage; 2
  | exception Rejection (_, reason) -> fail reason
  | Check (files, options) -> (
      let path = List.hd files in
      try check_file path (List.nth_opt files 1) options with
      | Failure reason -> fail (path ^ ": " ^ reason)
      | Step_certificate.Not_covered what -> fail (path ^ ": not covered: " ^ what))

let () =
  let status = run () in
  match flush stdout with
  | () -> exit status
  | exception Sys_error _ ->
      (* Output that cannot be written is not tried again at exit. *)
      prerr_string "touchstone-check-verified: standard output cannot be written\n";
      Unix._exit 2
